/** The shell: heading, pages, footer; loads the package before a page is shown. */
import { useEffect, useState } from 'preact/hooks';
import { askAhead } from './ahead.ts';
import { ShownCode } from './code/shown.tsx';
import { api, describeError, load, type Problem } from './data.ts';
import icon from './icon.svg?inline';
import { keepOffline, newRelease } from './offline/release.ts';
import { components, loadOthers, loadPage } from './pages.ts';
import { sessionProblem } from './session/session.ts';
import { SessionBar } from './session/session-bar.tsx';
import { misread } from './state/address.ts';
import { announcement } from './state/announce.ts';
import { lastParams, type Page, pageAddress, route, TITLES } from './state/route.ts';
import { type ThemeChoice, themeChoice } from './state/theme.ts';
import { dropProblem, watchDrops } from './ui/drop.ts';
import { Introduction } from './ui/introduction.tsx';
import { KeptNote } from './ui/kept.tsx';
import { Notice } from './ui/notice.tsx';

/** Whether the site has its API reference (vite.config.ts). */
declare const REFERENCE: boolean;

const DOCS = 'https://github.com/boresight/boresight';

export function App() {
  const [ready, setReady] = useState(false);
  const [problem, setProblem] = useState<Problem | null>(null);
  const { page } = route.value;
  const Shown = components.value[page];
  useEffect(() => {
    loadPage(page).catch((error: unknown) => setProblem(describeError(error)));
  }, [page]);
  useEffect(() => void loadOthers(), []);
  useEffect(() => {
    load().then(
      () => setReady(true),
      (error: unknown) => setProblem(describeError(error)),
    );
    askAhead(route.peek());
  }, []);
  useEffect(watchDrops, []);
  useEffect(() => void keepOffline(), []);
  useEffect(() => {
    document.title = `${TITLES[page]} – Boresight`;
  }, [page]);
  return (
    <>
      {/* biome-ignore lint/a11y/useValidAnchor: it is a link, whose hash must not replace the page's route. */}
      <a
        class="skip"
        href="#plots"
        onClick={(event) => {
          event.preventDefault();
          (document.getElementById('plots') ?? document.getElementById('content'))?.focus();
        }}
      >
        Skip to the plots
      </a>
      <header class="site-head">
        <p class="brand">
          <img src={icon} width="20" height="20" alt="" /> Boresight
        </p>
        <nav aria-label="Pages">
          {(Object.keys(TITLES) as Page[]).map((name) => (
            <a key={name} href={pageAddress(name, lastParams(name))} aria-current={name === page ? 'page' : undefined}>
              {TITLES[name]}
            </a>
          ))}
        </nav>
        <SessionBar ready={ready} />
        <label class="theme">
          <span class="visually-hidden">Colours</span>
          <select
            name="theme"
            title="Colours: the system's, light, or dark"
            value={themeChoice.value}
            onChange={(event) => {
              themeChoice.value = event.currentTarget.value as ThemeChoice;
            }}
          >
            <option value="auto">System colours</option>
            <option value="light">Light</option>
            <option value="dark">Dark</option>
          </select>
        </label>
      </header>
      <main id="content" tabIndex={-1}>
        <h1 class="visually-hidden">{TITLES[page]}</h1>
        {newRelease.value && (
          <Notice
            name="release"
            onClose={() => {
              newRelease.value = null;
            }}
          >
            A new version of this site is there.{' '}
            <button type="button" data-action="start-release" onClick={newRelease.value.start}>
              Reload
            </button>
          </Notice>
        )}
        {misread.value.length > 0 && (
          <Notice
            name="link"
            onClose={() => {
              misread.value = [];
            }}
          >
            Of this link, {misread.value.map((part) => `“${part}”`).join(', ')}{' '}
            {misread.value.length > 1 ? 'were' : 'was'} not understood; what usually is stands there instead.
          </Notice>
        )}
        {dropProblem.value && (
          <Notice
            name="drop"
            onClose={() => {
              dropProblem.value = null;
            }}
          >
            {dropProblem.value}
          </Notice>
        )}
        {sessionProblem.value && (
          <Notice
            name="session"
            onClose={() => {
              sessionProblem.value = null;
            }}
          >
            {sessionProblem.value}
          </Notice>
        )}
        <Introduction page={page} />
        {problem ? (
          <p class="alert" role="alert" data-error={problem.code}>
            <strong>Boresight could not start.</strong> {problem.message}
          </p>
        ) : ready && Shown ? (
          <Shown />
        ) : (
          <p class="panel loading" role="status">
            Loading the signal processing
          </p>
        )}
      </main>
      <footer class="site-foot">
        <KeptNote />
        <p title="The page’s content security policy forbids connections to anywhere but its own server and this machine.">
          Computed in this tab. Your data never leaves your machine.
        </p>
        <p>
          Boresight {ready ? api.version() : ''} <span aria-hidden="true">{'·'}</span>{' '}
          <a href={`${DOCS}#readme`}>Read me</a> <span aria-hidden="true">{'·'}</span>{' '}
          <a href={`${DOCS}/blob/main/docs/conventions.md`}>Frames, signs and units</a>{' '}
          <span aria-hidden="true">{'·'}</span> <a href={`${DOCS}/blob/main/docs/architecture.md`}>Architecture</a>
          {REFERENCE && (
            <>
              {' '}
              <span aria-hidden="true">{'·'}</span> <a href="reference/index.html">API reference</a>
            </>
          )}
        </p>
      </footer>
      <ShownCode />
      <p class="visually-hidden" role="status" aria-live="polite" data-live>
        {announcement.value}
      </p>
    </>
  );
}
