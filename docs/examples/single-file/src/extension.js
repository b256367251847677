import { mount } from './panel.js';

/** The entry of an extension of Foxglove or Lichtblick. */
export function activate(context) {
  const initPanel = ({ panelElement }) => mount(panelElement);
  context.registerPanel({ name: 'Two targets', initPanel });
}
