"""The process and its operating system: signals, output that may vanish, priority, which software it is; work that two
processes share."""
