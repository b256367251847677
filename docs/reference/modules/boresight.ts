/**
 * Simulation, estimation of angles, captures, images and calibration, on the calling thread.
 *
 * {@link init} first; what deals with drives and their calibration needs {@link initDrives}.
 *
 * @module boresight
 */
export * from 'boresight';
