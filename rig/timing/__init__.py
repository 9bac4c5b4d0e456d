"""When ticks came and when channels were latched, in constant memory."""
