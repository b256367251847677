/**
 * Networks: angles from snapshots, counting of sources, and models of one's own.
 *
 * @module boresight/neural
 */
export * from 'boresight/neural';
