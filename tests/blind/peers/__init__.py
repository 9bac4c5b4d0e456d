"""Other methods on the same cases and the same split into fitted and held-out runs, tuned on the fitted runs alone.

`python -m tests.blind.peers.compare DIR` needs the extra `peers` (scikit-learn, pysindy, sysidentpy). Each
predicts what the baseline leaves in the three channels; counted are the held-out error over the floor and the number
of families of effects that the method names.
"""
