"""What every analysis reads of a run: its trusted rows, what it declares, strokes, settled window, speed."""
