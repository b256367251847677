"""Training on one GPU without waiting for the host: assignment as a kernel, steps as CUDA graphs."""
