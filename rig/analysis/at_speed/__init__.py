"""What speed makes of the kinematic error: θ̃ split into pure and flexible part, and the speed that is slow enough."""
