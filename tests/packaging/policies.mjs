/** Content security policies of hosts, as the pages of more than one test have them. */

/** The policy of Lichtblick's desktop application, `packages/suite-desktop/src/main/index.ts` at 0987c08. */
export const LICHTBLICK = [
  "default-src 'self'",
  "script-src 'self' 'unsafe-inline' 'unsafe-eval'",
  "worker-src 'self' blob:",
  "style-src 'self' 'unsafe-inline'",
  "connect-src 'self' ws: wss: http: https: package: blob: data: file:",
  "font-src 'self' data:",
  "img-src 'self' data: https: package: x-foxglove-converted-tiff: http:",
  "media-src 'self' data: https: http: blob: file:",
].join('; ');
