/** Pages of the demo, and a selector that is there once a page has shown its data. */
export const pages = [{ name: 'start', path: '', ready: 'main' }];
