"""One file format a file; the catalogue is rig.runfile.importing.READERS."""
