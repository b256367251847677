/** Controls of a page as a person finds them: by role and name. */

export const control = (scope, role, name) => scope.getByRole(role, { name, exact: true });
const named = (role) => (scope, name) => control(scope, role, name);
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
