/** Vehicles of a tenant and the angles of their radars, asked for again every two seconds while the page is seen. */
import 'boresight/elements';

const EVERY_MS = 2000;
const WORDS = { aligned: 'aligned', misaligned: 'misaligned', undecided: 'undecided', none: 'no nominal angle' };
const GRAVITY = ['none', 'aligned', 'undecided', 'misaligned'];
const [state, entry, field, leave, main, list, none, section] = [
  'state',
  'entry',
  'token',
  'leave',
  '',
  'vehicles',
  'none',
  'vehicle',
].map((id) => /** @type {any} */ (id ? document.getElementById(id) : document.querySelector('main')));

let token = sessionStorage.getItem('token') ?? '';
/** @type {ReturnType<typeof setTimeout> | undefined} */
let timer;
let turn = 0;

/** @param {string} path */
async function ask(path) {
  const response = await fetch(path, { headers: { authorization: `Bearer ${token}` } });
  const answer = await response.json();
  if (!response.ok) throw Object.assign(new Error(answer.message), { status: response.status });
  return answer;
}

/** @param {string} tag @param {Record<string, unknown>} [properties] @param {...(Node | string)} children */
function made(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** @param {string} text @param {boolean} [problem] */
function say(text, problem = false) {
  if (state.textContent !== text) state.textContent = text;
  state.toggleAttribute('data-problem', problem);
}

const chosen = () => {
  try {
    return decodeURIComponent(location.hash.slice(1));
  } catch {
    return '';
  }
};
const gravest = (/** @type {{ alignment: string | null }[]} */ radars) =>
  GRAVITY[Math.max(0, ...radars.map(({ alignment }) => GRAVITY.indexOf(alignment ?? 'none')))] ?? 'none';
const degrees = (/** @type {number | null} */ value) => (value === null ? '–' : `${value.toFixed(2)}°`);
const count = (/** @type {number} */ value) => value.toLocaleString('en');
const total = (/** @type {Record<string, number>} */ counts) =>
  Object.values(counts).reduce((sum, one) => sum + one, 0);

/** @param {{ vehicle: string, radars: any[], quarantined?: string }[]} vehicles */
function showList(vehicles) {
  none.hidden = vehicles.length > 0;
  const links = new Map([...list.children].map((item) => [item.dataset.vehicle, item]));
  for (const { vehicle, radars, quarantined } of vehicles) {
    const item =
      links.get(vehicle) ?? made('li', {}, made('a', {}, made('span', { textContent: vehicle }), made('span')));
    links.delete(vehicle);
    item.dataset.vehicle = vehicle;
    const [link] = item.children;
    link.href = `#${encodeURIComponent(vehicle)}`;
    link.toggleAttribute('aria-current', vehicle === chosen());
    const verdict = gravest(radars);
    link.lastChild.dataset.alignment = verdict;
    link.lastChild.textContent = quarantined ? 'quarantined' : radars.length ? WORDS[verdict] : 'no radar';
    if (!item.isConnected) list.append(item);
  }
  for (const item of links.values()) item.remove();
}

/** @param {string} name */
function card(name) {
  const article = made('article', {}, made('boresight-mounting-angle'), made('dl'));
  article.dataset.radar = name;
  return article;
}

/** A history with the angle of now at its end. @param {any} history @param {number | null} timeS @param {any} result */
function withNow(history, timeS, { angleDeg, sigmaDeg }) {
  const now = timeS === null || timeS === history.timeS.at(-1) ? [] : [[timeS, angleDeg, sigmaDeg]];
  return {
    timeS: [...history.timeS, ...now.map(([time]) => time)],
    angleDeg: [...history.angleDeg, ...now.map(([, angle]) => angle)],
    // JSON has null where the deviation is infinite.
    sigmaDeg: [...history.sigmaDeg, ...now.map(([, , sigma]) => sigma)].map(
      (sigma) => sigma ?? Number.POSITIVE_INFINITY,
    ),
  };
}

/** @param {{ vehicle: string, receivedMs: number, radars: any[] } | null} given */
function showVehicle(given) {
  if (!given) {
    section.replaceChildren();
    delete section.dataset.vehicle;
    return;
  }
  const { vehicle, receivedMs, radars } = given;
  if (section.dataset.vehicle !== vehicle) {
    section.replaceChildren(made('h2', { textContent: vehicle }));
    section.dataset.vehicle = vehicle;
  }
  const cards = new Map([...section.querySelectorAll('article')].map((one) => [one.dataset.radar, one]));
  for (const {
    radar,
    timeS,
    nominalDeg,
    alarmDeg,
    alignment,
    history,
    frames,
    detections,
    repeated,
    refused,
    verdicts,
    result,
  } of radars) {
    const article = cards.get(radar) ?? card(radar);
    cards.delete(radar);
    const [plot, facts] = article.children;
    plot.setAttribute('heading', radar);
    plot.setAttribute('tolerance-deg', String(alarmDeg));
    plot.setAttribute('sigmas', '3');
    plot.setAttribute('tools', '');
    if (nominalDeg !== null) plot.setAttribute('nominal-deg', String(nominalDeg));
    plot.history = withNow(history, timeS, result);
    const verdict = alignment ?? 'none';
    const rows = [
      ['Verdict', WORDS[verdict], verdict],
      ['Angle', `${degrees(result.angleDeg)} ± ${degrees(result.sigmaDeg)}`],
      ['Nominal', degrees(nominalDeg)],
      ['Frames', count(frames)],
      ['Used', count(verdicts.used)],
      ['Detections', count(detections)],
      ['Sent again', count(repeated)],
      ['Refused', count(total(refused))],
      ['Last frame', new Date(receivedMs).toLocaleString()],
    ];
    facts.replaceChildren(
      ...rows.map(([name, value, verdict]) => {
        const told = made('dd', { textContent: value });
        if (verdict) told.dataset.alignment = verdict;
        return made('div', {}, made('dt', { textContent: name }), told);
      }),
    );
    if (!article.isConnected) section.append(article);
  }
  for (const one of cards.values()) one.remove();
}

async function update() {
  clearTimeout(timer);
  turn += 1;
  const mine = turn;
  if (document.hidden || !token) return;
  try {
    const { vehicles } = await ask('/v1/vehicles');
    const wanted = chosen() || vehicles[0]?.vehicle;
    const known = vehicles.some(({ vehicle }) => vehicle === wanted);
    if (mine !== turn) return;
    if (!chosen() && wanted) history.replaceState(null, '', `#${encodeURIComponent(wanted)}`);
    [main.hidden, entry.hidden, leave.hidden] = [false, true, false];
    sessionStorage.setItem('token', token);
    // The list is shown even where the vehicle is quarantined and cannot be.
    showList(vehicles);
    const vehicle = known ? await ask(`/v1/vehicles/${encodeURIComponent(wanted)}`).catch((error) => error) : null;
    if (mine !== turn) return;
    showVehicle(vehicle instanceof Error ? null : vehicle);
    if (vehicle instanceof Error) throw vehicle;
    if (chosen() && !known) say(`There is no vehicle ${chosen()}.`, true);
    else
      say(
        `${vehicles.length} ${vehicles.length === 1 ? 'vehicle' : 'vehicles'}, as of ${new Date().toLocaleTimeString()}`,
      );
  } catch (error) {
    if (mine !== turn) return;
    if (error.status === 401) return enter('This token is not one of a tenant.');
    say(error.status ? error.message : 'The service does not answer; trying again.', true);
  }
  timer = setTimeout(update, EVERY_MS);
}

/** Asks for a token. @param {string} problem */
function enter(problem) {
  token = '';
  sessionStorage.removeItem('token');
  [main.hidden, entry.hidden, leave.hidden] = [true, false, true];
  say(problem, problem !== '');
  field.focus();
}

entry.addEventListener('submit', (event) => {
  event.preventDefault();
  token = field.value.trim();
  field.value = '';
  update();
});
leave.addEventListener('click', () => {
  turn += 1;
  clearTimeout(timer);
  enter('');
});
addEventListener('hashchange', update);
document.addEventListener('visibilitychange', update);
if (token) update();
else enter('');
