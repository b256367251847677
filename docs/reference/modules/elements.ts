/**
 * Radar plots as custom elements.
 *
 * @module boresight/elements
 */
export * from 'boresight/elements';
