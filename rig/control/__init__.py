"""Control laws and references as pure values and functions of time; no device, no clock."""
