"""The figures and tables of the paper, drawn anew from a campaign, each with what the paper says of it and whether the
data say so too: one file a figure, from readings of runs to curves and claims.
"""
