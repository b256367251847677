/**
 * All of `boresight/neural` in one file.
 *
 * @module boresight/inline/networks
 */
export * from 'boresight/inline/networks';
