"""What is read: a folder of runs, brought to one grid, split into fitted and held out."""
