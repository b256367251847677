/** Controls of a page as a person finds them: by role and name. */

export const control = (scope, role, name) => scope.getByRole(role, { name, exact: true });
const named = (role) => (scope, name) => control(scope, role, name);
export const button = named('button');
export const checkbox = named('checkbox');
export const combobox = named('combobox');
export const figure = named('figure');
export const region = named('region');
export const spinbutton = named('spinbutton');
/** The part of a plot that takes keyboard input. */
export const plotOf = (page, name) => figure(page, name).getByRole('application');

/** Waits two animation frames, so that the page can draw. */
export const twoFrames = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** The progress bar of a task. */
export const progress = (page, name) => page.getByRole('progressbar', { name, exact: true });
/** Selector of the task's cancel button, for scripts in the page. */
export const cancelOf = (name) => `progress[aria-label="${name}"] ~ button`;

/** Opens the file chooser with a control and selects files. */
export async function choose(page, opener, list) {
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), opener.click()]);
  await chooser.setFiles(
    list.map(({ name, bytes }) => ({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) })),
  );
}
