"""What the sensors themselves put into a reading: noise and drift at rest, latch skew, rows in step with the counts."""
