"""The sources named in docstrings as `[key, Eq. n]`. A test checks that every key used stands here."""

REFERENCES: dict[str, str] = {
    "ghorbel2001": "F. H. Ghorbel, P. S. Gandhi, F. Alpeter, On the Kinematic Error in Harmonic Drive Gears, "
    "ASME J. Mechanical Design 123 (2001) 90-97",
    "karnopp1985": "D. Karnopp, Computer simulation of stick-slip friction in mechanical dynamic systems, "
    "ASME J. Dynamic Systems, Measurement and Control 107 (1985) 100-103",
    "armstrong1994": "B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools and "
    "compensation methods for the control of machines with friction, Automatica 30 (1994) 1083-1138",
    "gum": "JCGM 100:2008, Evaluation of measurement data: Guide to the expression of uncertainty in measurement",
    "tuttle1992": "T. D. Tuttle, Understanding and modeling the behavior of a harmonic drive gear transmission, "
    "MIT Artificial Intelligence Laboratory, Technical Report 1365 (1992)",
    "astrom2006": "K. J. Åström, T. Hägglund, Advanced PID Control, ISA (2006)",
}
