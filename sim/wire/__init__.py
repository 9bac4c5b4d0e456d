"""The twin on the wire: a process of its own that speaks CAN frames and serial bytes, in real time.

Modelled time runs in an agenda of events (`agenda`) that the wall clock pulls along (`reactor`), so that frames, plant
and node timers keep their order and their distances whatever the machine's scheduler does, and tests need no clock.
"""
