/** A server of pages with content security policies. */
import { createServer } from 'node:http';

/** Serves what `contentOf` gives for a name: a type, a content and perhaps a policy. */
export async function servePages(contentOf) {
  const server = createServer((request, response) => {
    const name = new URL(request.url, 'http://host').pathname.slice(1);
    if (name === 'favicon.ico') return response.writeHead(204).end();
    const [type, content, policy] = contentOf(name);
    const headers = { 'Content-Type': type, 'Access-Control-Allow-Origin': '*' };
    return response.writeHead(200, policy ? { ...headers, 'Content-Security-Policy': policy } : headers).end(content);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { url: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}
