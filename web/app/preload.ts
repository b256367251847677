/** Has a file fetched before it is asked for. */
export function preload(address: string): void {
  const link = document.createElement('link');
  Object.assign(link, { rel: 'preload', as: 'fetch', crossOrigin: 'anonymous', fetchPriority: 'low', href: address });
  document.head.append(link);
}
