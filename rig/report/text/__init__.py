"""Results as lines of plain text: what a terminal shows and a summary keeps."""
