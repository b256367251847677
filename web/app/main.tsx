import { render } from 'preact';
import './style.css';
import { App } from './app.tsx';
import icon from './icon.svg?inline';

// Browsers ask for an icon that has an address again at every step of the history.
document.head.append(Object.assign(document.createElement('link'), { rel: 'icon', type: 'image/svg+xml', href: icon }));

const host = document.getElementById('app');
if (host) render(<App />, host);
