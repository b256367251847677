"""Networks that estimate the motion of a radar from the Doppler point clouds of a drive."""
