/**
 * All of `boresight` and `boresight/worker` in one file.
 *
 * @module boresight/inline
 */
export * from 'boresight/inline';
