/**
 * The same work on threads of its own, with progress and cancel: {@link createPool}.
 *
 * @module boresight/worker
 */
export * from 'boresight/worker';
