/** The page Capture as a person finds it. */
import { figure, region } from '../lib/controls.mjs';

const patient = { timeout: 60_000 };

/** Once detections of the present settings are there. */
export const ready = (page) =>
  page
    .locator('[aria-busy="false"] [data-table="detections"] [data-field="rangeM"][data-value]')
    .first()
    .waitFor(patient);

/** Once a file is listed as open; on phones the list is folded away. */
export const opened = (page, name) => page.locator('.files', { hasText: name }).waitFor({ state: 'attached' });

/** Buttons of detections that show their cell. */
export const cells = (page) => region(page, 'Detections').getByRole('button', { name: /show the cell/ });
export const chosenRow = (page) => region(page, 'Detections').getByRole('row', { selected: true });

/** The bar of frames: its buttons, its slider, and what it says. */
export const frames = (page) => region(page, 'Frames');
export const frameSlider = (page) => frames(page).getByRole('slider', { name: 'Frame' });
export const frameSays = (page, text) => frames(page).getByRole('status').filter({ hasText: text }).waitFor();

/** Once a plot says something below it. */
export const captionOf = (page, name, text) =>
  figure(page, name).locator('figcaption').filter({ hasText: text }).waitFor();
