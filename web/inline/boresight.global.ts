// `boresight/inline` for a page without modules: a classic script that puts it on globalThis.
import * as inline from './boresight.js';

declare global {
  var boresight: typeof inline;
}

globalThis.boresight = inline;
