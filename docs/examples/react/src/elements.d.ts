import type { JsxElements } from 'boresight/elements';

declare module 'react' {
  namespace JSX {
    interface IntrinsicElements extends JsxElements {}
  }
}
