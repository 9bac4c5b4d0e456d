"""Order analysis: least squares in blocks, spectra per turn, revolutions as Fourier series, angles aligned."""
