"""What a page talks to: a web process without a device. It starts the station, hands acts on, shows what comes back."""
