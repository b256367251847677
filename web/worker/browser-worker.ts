// Runs in a browser's worker.
import type { Reply, Request, Setup } from './protocol.js';
import { serve } from './serve.js';

/** The few things used of a worker's global scope, which the DOM's types do not have. */
const scope = self as unknown as {
  postMessage(reply: Reply, transfer: Transferable[]): void;
  onmessage: (event: MessageEvent<Setup | Request>) => void;
};

const answer = serve((reply, transfer) => scope.postMessage(reply, transfer));
scope.onmessage = ({ data }) => answer(data);
