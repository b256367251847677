import { render } from 'preact';
import './style.css';
import { App } from './app.tsx';

const host = document.getElementById('app');
if (host) render(<App />, host);
