"""The run folder: made, closed, mended, checked, listed and read here, and nowhere else. Its format is `hdrig.run/1`.

| module | one idea |
|---|---|
| folder | `create`: a new run folder, status "running" |
| manifest | `manifest.json`, changed only by atomic rename |
| events | `events.jsonl`, one line an event |
| columns | samples as Arrow columns with unit and meaning |
| journal | `journal-0001.arrows`, appended while running |
| archive | journal → `samples.parquet` |
| finalise | close a run in named, repeatable steps |
| recover | what a killed program left → a readable run |
| verify | does the folder keep its promises |
| listing | run folders below a folder |
| planned | the runs a campaign calls done, and where they lie |
| copies | one run in several folders, taken once |
| process | who writes a run, and whether they live |
| samples | archive or journal, one channel at a time |
| thermometer | which channel is the temperature of the gear |
| run | `Run`: columns when asked for, whoever made the folder |
| export/ | CSV, MDF4, MCAP, HDF5; one format a file |
| importing/ | files of other loggers → run folders |

Import from the modules: this package loads nothing by itself, so that the recorder and `--help` start quickly.
"""
