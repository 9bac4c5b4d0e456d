"""The run folder: made, closed, mended, checked, listed and read here, and nowhere else. Its format is `hdrig.run/1`.

A run is made by `folder`, written by `journal` and `events`, closed by `finalise`, mended by `recover` and `restore`,
checked by `verify`, and read by `run`, whoever made the folder; `export/` and `importing/` speak the formats of others.
Each module says at its top what it is for.

Import from the modules: this package loads nothing by itself, so that the recorder and `--help` start quickly.
"""
