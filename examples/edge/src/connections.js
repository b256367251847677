/** Connections of Node's server that send no request. */

/**
 * Limits connections that have not sent the headers of a request: where one comes too many, the oldest is closed. A client
 * that sends its request at once has nothing to fear from those that do not.
 *
 * @param {number} most
 */
export function limitHalfOpen(most) {
  /** In the order in which they came. @type {Set<import('node:net').Socket>} */
  const waiting = new Set();
  let withoutRequest = 0;
  let due = false;
  const drop = (/** @type {import('node:net').Socket} */ socket) => {
    if (waiting.delete(socket)) withoutRequest += 1;
  };
  const evict = () => {
    due = false;
    for (const socket of waiting) {
      if (waiting.size <= most) return;
      drop(socket);
      socket.destroy();
    }
  };
  return {
    connections: {
      get halfOpen() {
        return waiting.size;
      },
      get withoutRequest() {
        return withoutRequest;
      },
    },
    /** @param {import('node:http').Server} server */
    attach(server) {
      server.on('connection', (socket) => {
        waiting.add(socket);
        socket.once('close', () => drop(socket));
        if (waiting.size <= most || due) return;
        due = true;
        // Many that come at once are accepted before what they sent is read, which the next turn of the loop does.
        setImmediate(() => setImmediate(evict));
      });
      server.on('request', ({ socket }) => waiting.delete(socket));
    },
  };
}
