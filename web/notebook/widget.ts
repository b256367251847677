/**
 * The front end of the Python package boresight-widget, one module for all hosts: anywidget asks for its default export
 * without arguments, and Streamlit calls it with a component.
 */
import { define } from '../elements/index.ts';
import { anywidget } from './anywidget.ts';
import { type Component, streamlit } from './streamlit.ts';

export { pack, unpack } from './codec.ts';

define();

export default (component?: Component) => (component?.parentElement ? streamlit(component) : anywidget);
