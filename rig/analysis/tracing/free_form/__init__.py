"""What is left, drawn by free forms where it acts: a law of many numbers, none of which means anything.

A curve along a coordinate of one channel foretells that channel. What is in the torque sensor's reading is in the
kinematic error and the motor's torque as well, and one form there foretells all three: fitted with everything else, and
named after no effect.

ranges.py   what fitted runs cover, cut into knots
factors.py  what a form is made of: hats, waves, what wears off
along.py    what a form may run along
form.py     one form at one port
forms.py    all that may act along a coordinate
fitted.py   a form in the model, and how much fitted runs want it
drawn.py    the one that fitted runs want most, and what unseen runs say of it
along_another.py   whether what seems to live along one coordinate is far rather a form along another
"""
