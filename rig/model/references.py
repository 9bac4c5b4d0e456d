"""The sources named in docstrings as `[key, Eq. n]`. A test checks that every key used stands here."""

REFERENCES: dict[str, str] = {
    "ghorbel2001": "F. H. Ghorbel, P. S. Gandhi, F. Alpeter, On the Kinematic Error in Harmonic Drive Gears, "
    "ASME J. Mechanical Design 123 (2001) 90-97",
    "karnopp1985": "D. Karnopp, Computer simulation of stick-slip friction in mechanical dynamic systems, "
    "ASME J. Dynamic Systems, Measurement and Control 107 (1985) 100-103",
    "armstrong1994": "B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools and "
    "compensation methods for the control of machines with friction, Automatica 30 (1994) 1083-1138",
    "hess1990": "D. P. Hess, A. Soom, Friction at a lubricated line contact operating at oscillating sliding "
    "velocities, ASME Journal of Tribology 112 (1990) 147-152",
    "friedrich2008": "F. Friedrich, A. Kempe, V. Liebscher, G. Winkler, Complexity penalized M-estimation: fast "
    "computation, J. Computational and Graphical Statistics 17 (2008) 201-224",
    "fuller1987": "W. A. Fuller, Measurement Error Models, Wiley (1987)",
    "cody1980": "W. J. Cody, W. Waite, Software Manual for the Elementary Functions, Prentice-Hall (1980)",
    "liang1986": "K.-Y. Liang, S. L. Zeger, Longitudinal data analysis using generalized linear models, "
    "Biometrika 73 (1986) 13-22",
    "mackinnon1985": "J. G. MacKinnon, H. White, Some heteroskedasticity-consistent covariance matrix estimators with "
    "improved finite sample properties, Journal of Econometrics 29 (1985) 305-325",
    "angrist2009": "J. D. Angrist, J.-S. Pischke, Mostly Harmless Econometrics, Princeton University Press (2009)",
    "bell2002": "R. M. Bell, D. F. McCaffrey, Bias reduction in standard errors for linear regression with multi-stage "
    "samples, Survey Methodology 28 (2002) 169-181",
    "meier1953": "P. Meier, Variance of a weighted mean, Biometrics 9 (1953) 59-73",
    "preisig1993": "H. A. Preisig, D. W. T. Rippin, Theory and application of the modulating function method, "
    "Computers & Chemical Engineering 17 (1993) 1-16",
    "paule1982": "R. C. Paule, J. Mandel, Consensus values and weighting factors, "
    "J. Research of the National Bureau of Standards 87 (1982) 377-385",
    "gum": "JCGM 100:2008, Evaluation of measurement data: Guide to the expression of uncertainty in measurement",
    "vonneumann1941": "J. von Neumann, R. H. Kent, H. R. Bellinson, B. I. Hart, The mean square successive difference, "
    "Annals of Mathematical Statistics 12 (1941) 153-162",
    "tuttle1992": "T. D. Tuttle, Understanding and modeling the behavior of a harmonic drive gear transmission, "
    "MIT Artificial Intelligence Laboratory, Technical Report 1365 (1992)",
    "dahl1968": "P. R. Dahl, A solid friction model, The Aerospace Corporation, TOR-0158(3107-18)-1 (1968)",
    "wolf2018": "S. Wolf, M. Iskandar, Extending a dynamic friction model with nonlinear viscous and thermal "
    "dependency for a motor and harmonic drive gear, IEEE Int. Conf. Robotics and Automation (2018) 783-790",
    "seyfferth1995": "W. Seyfferth, A. J. Maghzal, J. Angeles, Nonlinear modeling and parameter identification of "
    "harmonic drive robotic transmissions, IEEE Int. Conf. Robotics and Automation (1995) 3027-3032",
    "wen1976": "Y.-K. Wen, Method for random vibration of hysteretic systems, J. Engineering Mechanics Division "
    "ASCE 102 (1976) 249-263",
    "oh2005": "J. Oh, D. S. Bernstein, Semilinear Duhem model for rate-independent and rate-dependent hysteresis, IEEE "
    "Trans. Automatic Control 50 (2005) 631-645",
    "kuhnen2003": "K. Kuhnen, Modeling, identification and compensation of complex hysteretic nonlinearities: a "
    "modified Prandtl-Ishlinskii approach, European J. Control 9 (2003) 407-418",
    "bartlett1950": "M. S. Bartlett, Periodogram analysis and continuous spectra, Biometrika 37 (1950) 1-16",
    "findley1976": "W. N. Findley, J. S. Lai, K. Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials, "
    "North-Holland (1976)",
    "lugt2013": "P. M. Lugt, Grease Lubrication in Rolling Bearings, Wiley (2013)",
    "nordin2002": "M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash - a survey, "
    "Automatica 38 (2002) 1633-1649",
    "krause2013": "P. C. Krause, O. Wasynczuk, S. D. Sudhoff, S. Pekarek, Analysis of Electric Machinery and Drive "
    "Systems, 3rd ed., Wiley (2013)",
    "jia2021": "H. Jia et al., Modeling and analysis of pure kinematic error in harmonic drive, "
    "Mechanism and Machine Theory 155 (2021) 104122",
    "taghirad1999": "H. D. Taghirad, P. R. Bélanger, Intelligent built-in torque sensor for harmonic drive systems, "
    "IEEE Trans. Instrumentation and Measurement 48 (1999) 1201-1207",
    "heidenhain": "Dr. Johannes Heidenhain GmbH, Modular Angle Encoders, catalogue: a scale that runs beside the "
    "shaft's centre, by its eccentricity or by the bearing's radial play",
    "harmonicdrive": "Harmonic Drive SE / LLC, CSF and CSG component sets, engineering data of the catalogue",
    "astrom2006": "K. J. Åström, T. Hägglund, Advanced PID Control, ISA (2006)",
    "iso11898": "ISO 11898-1, Road vehicles, Controller area network (CAN), Part 1: Data link layer",
    "cia301": "CAN in Automation, CiA 301, CANopen application layer and communication profile",
    "cia303": "CAN in Automation, CiA 303-2, CANopen additional specification: Representation of SI units and prefixes",
    "cia402": "CAN in Automation, CiA 402, CANopen device profile for drives and motion control; IEC 61800-7-201",
    "cia404": "CAN in Automation, CiA 404, CANopen device profile for measuring devices and closed-loop controllers",
    "cia406": "CAN in Automation, CiA 406, CANopen device profile for encoders",
    "lawicel": "Lawicel AB, CANUSB, ASCII commands of its manual (the slcan protocol)",
    "odrive": "ODrive Robotics, CAN protocol (CANSimple) and firmware 0.5.6, odriverobotics.com/docs",
    "usdigital": "US Digital, QSB, list of commands, version 1.28",
    "randall2011": "R. B. Randall, Vibration-based Condition Monitoring, Wiley (2011)",
    "thomson1993": "W. T. Thomson, Theory of Vibration with Applications, 4th ed., Prentice-Hall (1993)",
    "rife1974": "D. C. Rife, R. R. Boorstyn, Single-tone parameter estimation from discrete-time observations, "
    "IEEE Trans. Information Theory 20 (1974) 591-598",
    "anderson1965": "D. G. Anderson, Iterative procedures for nonlinear integral equations, J. ACM 12 (1965) 547-560",
    "efron1982": "B. Efron, The Jackknife, the Bootstrap and Other Resampling Plans, SIAM (1982)",
    "hastie2009": "T. Hastie, R. Tibshirani, J. Friedman, The Elements of Statistical Learning, 2nd ed., "
    "Springer (2009)",
    "rasmussen2006": "C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning, MIT Press (2006)",
    "vig1992": "J. R. Vig, Introduction to quartz frequency standards, US Army Research Laboratory, SLCET-TR-92-1 "
    "(1992)",
    "iwan1966": "W. D. Iwan, A distributed-element model for hysteresis and its steady-state dynamic response, "
    "ASME J. Applied Mechanics 33 (1966) 893-900",
}
