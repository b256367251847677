/** The extension for Foxglove and Lichtblick: conversions of radar messages, and panels. */
import type { ExtensionContext } from '@foxglove/extension';
import { registerConverters } from './converters/index.ts';
import { registerPanel } from './panel.ts';
import { birdsEyePanel } from './panels/birds-eye.ts';
import { dopplerPanel } from './panels/doppler.ts';
import { mountingPanel } from './panels/mounting.ts';
import { followVariables } from './signs.ts';

/** What the applications call once they have run the script. */
export function activate(context: ExtensionContext): void {
  followVariables(context);
  registerConverters(context);
  registerPanel(context, mountingPanel);
  registerPanel(context, dopplerPanel);
  registerPanel(context, birdsEyePanel);
}
