/** The page Capture, and controls of any page, as a person finds them. */

const named = (role) => (scope, name) => scope.getByRole(role, { name, exact: true });
export const button = named('button');
export const checkbox = named('checkbox');
export const combobox = named('combobox');
export const figure = named('figure');
export const region = named('region');
export const spinbutton = named('spinbutton');
/** A plot as what takes keys. */
export const plotOf = (page, name) => figure(page, name).getByRole('application');

/** Two frames of the page, in which it may draw. */
export const twoFrames = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

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

/** The bar of work of that name. */
export const progress = (page, name) => page.getByRole('progressbar', { name, exact: true });
/** Its button to cancel, for scripts in the page. */
export const cancelOf = (name) => `progress[aria-label="${name}"] ~ button`;

/** Chooses files with a button of the page. */
export async function choose(page, opener, list) {
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), opener.click()]);
  await chooser.setFiles(
    list.map(({ name, bytes }) => ({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) })),
  );
}
