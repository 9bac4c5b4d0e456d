"""The bench file, read strictly."""
