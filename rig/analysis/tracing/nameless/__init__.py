"""Laws that are no effect of the library: look-alikes of one, and numbers of the paper's model that are no constants.

One is searched for as an effect is, and never named. Where it explains most, the report says in a sentence what changes
with what. The second kind is the model's own list, crossed with what may change it: spring, kinematic error, torques as
read and as told, against time, speed, direction and the angle of the output. Bins along a coordinate, as in `residual`,
find what is loud; a law of a few numbers finds what is half a floor.

law.py       what all of them have in common
loops.py     what stays behind
springs.py   a stiffness that is no constant       errors.py   a kinematic error that is none
readings.py  sensors and the torque constant       drags.py    friction, and what hangs on the load
inertias.py  an inertia that is no constant       angles.py   an angle read to another scale
"""
