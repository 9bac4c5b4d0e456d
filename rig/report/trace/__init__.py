"""A trace as a page: what the model lacks, told in the order an engineer asks."""
