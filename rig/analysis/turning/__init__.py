"""What one run of a turning motor gives: kinematic error, orders, accuracy, torsion, speed and torque held."""
