/** The report of what is shown, as a page of HTML to print or to keep. */
import { signal } from '@preact/signals';
import type { ReportAbout } from 'boresight';
import { download, fileName } from '../../../../plots/save.ts';
import { aborted, describeError, type Problem, pool } from '../../../data.ts';
import { bundledFiles, type Loaded, loaded, sensor, simulation } from '../drive/drive.ts';
import { fileParts } from '../plots/time-plot.tsx';
import { calibrationOptions, mountingState } from '../state.ts';
import { jointOptions, shownMethod, where, withNetwork } from './process.ts';

/** How far the report is, and what ends it. */
const writing = signal<{ share: number; controller: AbortController } | null>(null);
const problem = signal<Problem | null>(null);

/** Digest of bytes in hexadecimal digits; browsers have none for pages that are not served securely. */
async function sha256(bytes: ArrayBuffer): Promise<string> {
  if (!globalThis.crypto?.subtle) return 'not computed: this page is not served securely';
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
  return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
}

/** Files as they were opened; of the bundled drive those that are served. */
async function sourcesOf(open: Loaded, signal: AbortSignal): Promise<NonNullable<ReportAbout['sources']>> {
  const files: [string, () => Promise<ArrayBuffer>][] =
    open.source === 'delphi'
      ? bundledFiles.map(([name, address]) => [
          `${name}, as served`,
          async () => (await fetch(address, { signal })).arrayBuffer(),
        ])
      : open.own.map(({ name, file }) => [name, () => file.arrayBuffer()]);
  return Promise.all(
    files.map(async ([name, read]) => {
      const bytes = await read();
      return { name, bytes: bytes.byteLength, sha256: await sha256(bytes) };
    }),
  );
}

async function write(): Promise<void> {
  const open = loaded.value;
  const radar = sensor.value;
  const way = shownMethod.value;
  const common = open && where.value && calibrationOptions(mountingState.value, where.value, open.drive.format);
  if (!open || !radar || !way || !common) return;
  const controller = new AbortController();
  const { signal } = controller;
  writing.value = { share: 0, controller };
  problem.value = null;
  try {
    const mine = await withNetwork(way, { sensor: radar.id, ...common });
    const options = way === 'joint' ? jointOptions(open.drive, mine) : { ...mine, method: way };
    const shown = { ...options, ...(mine.network && { network: 'its bytes' }) };
    const drive =
      open.source === 'simulated' ? `simulateDrive(${JSON.stringify(simulation(mountingState.value))})` : 'drive';
    const about: ReportAbout = {
      made: new Date().toLocaleString('en-GB', { dateStyle: 'long', timeStyle: 'short' }),
      asked: `calibrationReport(${drive}, about, ${JSON.stringify(shown)})`,
      sources: await sourcesOf(open, signal),
    };
    const onProgress = (done: number, total: number): void => {
      if (!signal.aborted) writing.value = { share: done / Math.max(total, 1), controller };
    };
    const html = await pool().calibrationReport(open.drive, about, options, { signal, onProgress });
    download(new Blob([html], { type: 'text/html;charset=utf-8' }), fileName(['mounting', ...fileParts()], 'html'));
  } catch (error) {
    if (!aborted(error)) problem.value = describeError(error);
  } finally {
    if (writing.value?.controller === controller) writing.value = null;
  }
}

export function ReportButton() {
  const under = writing.value;
  return under ? (
    <button type="button" data-export="report" onClick={() => under.controller.abort()}>
      Cancel report, {Math.round(100 * under.share)} %
    </button>
  ) : (
    <button
      type="button"
      data-export="report"
      title="Save a report to print: verdict, plots, conditions, and the digests of the files"
      onClick={() => void write()}
    >
      Report
    </button>
  );
}

export function ReportProblem() {
  return (
    problem.value && (
      <p class="alert" role="alert" data-error={problem.value.code}>
        The report could not be written: {problem.value.message} <code>{problem.value.code}</code>
      </p>
    )
  );
}
