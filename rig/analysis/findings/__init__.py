"""What an analysis gives: figures with 95 % intervals, checks, curves; and the limits they are judged by."""
