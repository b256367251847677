/** Captures with the JSON of mmWave Studio in place of a .cfg. */
import assert from 'node:assert/strict';
import { drop, recording } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { json, setup, studio } from './studio.mjs';

const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = recording('profile.cfg');

const opened = (page, name) =>
  page.waitForFunction((wanted) => document.querySelector('.files')?.textContent.includes(wanted), name);
const ready = (page) =>
  page.waitForSelector('[aria-busy="false"] [data-table="detections"] [data-field="rangeM"][data-value]');
const rows = (page) =>
  page
    .locator('[data-table="detections"] tbody [data-field][data-value]')
    .evaluateAll((cells) => cells.map(({ dataset }) => `${dataset.field} ${dataset.value}`));
const facts = (page) => page.locator('[data-facts="capture"]').innerText();

browserTest(
  'studio: its JSON gives the same results as the .cfg of the same settings',
  { path: '#/angle' },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    await drop(page, [
      { name: 'a.bin', bytes: bin },
      { name: 'a.cfg', bytes: cfg },
    ]);
    await opened(page, 'a.bin');
    await ready(page);
    const [wanted, said] = [await rows(page), await facts(page)];
    await page.getByRole('link', { name: 'Angle lab' }).click();
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    await drop(page, [
      json('mine.mmwave.json', studio()),
      json('mine.setup.json', setup),
      { name: 'b.bin', bytes: bin },
    ]);
    await opened(page, 'b.bin');
    assert.match(page.url(), /#\/capture/);
    await ready(page);
    assert.deepEqual(await rows(page), wanted);
    assert.equal(await facts(page), said);
    assert.match(
      await page.locator('.files').innerText(),
      /\.json\s+mine\.mmwave\.json[\s\S]*\.json\s+mine\.setup\.json/,
    );
    // Other settings give other results: the numbers are those of this file.
    const slower = studio();
    slower.mmWaveDevices[0].rfConfig.rlProfiles[0].rlProfileCfg_t.freqSlopeConst_MHz_usec = 30;
    slower.mmWaveDevices[0].rfConfig.rlFrameCfg_t.framePeriodicity_msec = 80;
    await drop(page, [json('slow.mmwave.json', slower), json('slow.setup.json', setup)]);
    await opened(page, 'slow.setup.json');
    await page.waitForFunction(() => /10\.\d.cm/.test(document.querySelector('[data-facts="capture"]')?.innerText));
    assert.match(await facts(page), /16 × 2 chirps, 80\.0.ms/);
  },
);

browserTest('studio: in any order, and without the board by hand', { path: '#/capture' }, async ({ page }) => {
  await ready(page);
  await drop(page, [json('mine.setup.json', setup)]);
  await page.waitForSelector('[data-waiting="bin,cfg"]');
  await drop(page, [{ name: 'mine.bin', bytes: bin }]);
  await page.waitForSelector('[data-waiting="cfg"]');
  await drop(page, [json('mine.mmwave.json', studio())]);
  await ready(page);
  const wanted = await rows(page);
  // The board is not known without its setup, and can be chosen.
  await drop(page, [{ name: 'other.bin', bytes: bin }, json('other.mmwave.json', studio())]);
  await opened(page, 'other.bin');
  const alert = page.locator('[role="alert"][data-error]');
  await alert.waitFor();
  assert.match(await alert.innerText(), /Virtual array/);
  await page.locator('select[name="array"]').selectOption('awr1642');
  await ready(page);
  assert.deepEqual(await rows(page), wanted);
});

browserTest(
  'studio: what cannot be read is refused by the name of its field',
  { path: '#/capture' },
  async ({ page }) => {
    await ready(page);
    const rf = 'mmWaveDevices[0].rfConfig';
    const cases = [
      [
        ({ rf }) => delete rf.rlProfiles[0].rlProfileCfg_t.numAdcSamples,
        `${rf}.rlProfiles[0].rlProfileCfg_t.numAdcSamples is missing`,
      ],
      [({ rf }) => delete rf.rlFrameCfg_t, `${rf}.rlFrameCfg_t.chirpStartIdx is missing`],
      [
        ({ rf }) => {
          rf.rlProfiles[0].rlProfileCfg_t.digOutSampleRate = 'fast';
        },
        `${rf}.rlProfiles[0].rlProfileCfg_t.digOutSampleRate is "fast"`,
      ],
      [
        ({ rf }) => {
          rf.rlChirps[1].rlChirpCfg_t.txEnable = '0x3';
        },
        `${rf}.rlChirps[1].rlChirpCfg_t.txEnable is "0x3"; expected the bit of one transmitter`,
      ],
      [
        ({ rf }) => {
          rf.rlChirps[1].rlChirpCfg_t.startFreqVar_MHz = 2;
        },
        `${rf}.rlChirps[1].rlChirpCfg_t.startFreqVar_MHz is 2`,
      ],
      [
        ({ rf }) => {
          rf.rlChanCfg_t.cascading = 1;
        },
        `${rf}.rlChanCfg_t.cascading is 1; expected 0: one chip`,
      ],
      [
        ({ rf }) => {
          rf.waveformType = 'advancedFrameChirp';
        },
        `${rf}.waveformType is "advancedFrameChirp"`,
      ],
      [
        ({ rf }) => {
          rf.rlAdcOutCfg_t.fmt.b2AdcOutFmt = 3;
        },
        `${rf}.rlAdcOutCfg_t.fmt.b2AdcOutFmt is 3; expected 0 (real), 1 or 2`,
      ],
      [
        ({ rf }) => {
          rf.rlBpmChirps = [{ rlBpmChirpCfg_t: { constBpmVal: '0x1' } }];
        },
        `${rf}.rlBpmChirps[0].rlBpmChirpCfg_t.constBpmVal is "0x1"`,
      ],
      [
        ({ raw }) => {
          raw.rlDevDataFmtCfg_t.chInterleave = 0;
        },
        'rawDataCaptureConfig.rlDevDataFmtCfg_t.chInterleave is 0',
      ],
      [
        ({ raw }) => {
          raw.rlDevLaneEnable_t.laneEn = '0xF';
        },
        'rawDataCaptureConfig.rlDevDataFmtCfg_t.chInterleave is 1; expected 0: receivers sample by sample, over four lanes',
      ],
      [
        ({ raw }) => {
          raw.rlDevLaneEnable_t.laneEn = '0x1';
        },
        'rawDataCaptureConfig.rlDevLaneEnable_t.laneEn is "0x1"; expected 0x3: two lanes',
      ],
      [
        ({ raw }) => {
          raw.rlDevDataPathCfg_t.transferFmtPkt0 = '0x6';
        },
        'rlDevDataPathCfg_t.transferFmtPkt0 is "0x6"',
      ],
      [({ all }) => all.mmWaveDevices.push(all.mmWaveDevices[0]), 'mmWaveDevices is 2 devices'],
      // What the package itself refuses, by what of the JSON it came from.
      [
        ({ rf }) => {
          rf.rlProfiles[0].rlProfileCfg_t.rampEndTime_usec = 20;
        },
        `${rf}.rlProfiles[0].rlProfileCfg_t: time of the last sample`,
      ],
      [
        ({ rf }) => {
          rf.rlFrameCfg_t.chirpEndIdx = 5;
        },
        `${rf}.rlFrameCfg_t: chirps`,
      ],
    ];
    for (const [change, says] of cases) {
      const all = studio();
      const [device] = all.mmWaveDevices;
      change({ all, rf: device.rfConfig, raw: device.rawDataCaptureConfig });
      await drop(page, [json('wrong.mmwave.json', all), { name: 'mine.bin', bytes: bin.subarray(0, 131_072) }]);
      await page
        .waitForFunction(
          (text) => document.querySelector('[role="alert"][data-error]')?.textContent.includes(text),
          says,
        )
        .catch(async () => assert.fail(`${says}: ${await page.locator('[role="alert"]').allInnerTexts()}`));
      assert.match(await page.locator('[role="alert"][data-error]').innerText(), /^wrong\.mmwave\.json: /);
    }
    for (const [files, says] of [
      [[json('mine.mmwave.json', 'hello')], 'is no JSON'],
      [[json('mine.mmwave.json', '[1]')], 'mmWaveDevices is missing'],
      [[json('mine.mmwave.json', studio()), { name: 'mine.cfg', bytes: cfg }], 'one configuration'],
      [[json('mine.setup.json', { mmWaveDevice: 5 }), json('mine.mmwave.json', studio())], 'mmWaveDevice is 5'],
      [[json('mine.setup.json', setup), { name: 'mine.cfg', bytes: cfg }], 'a .mmwave.json is expected with it'],
    ]) {
      await drop(page, files);
      await page.waitForFunction(
        (text) => document.querySelector('[role="alert"][data-error]')?.textContent.includes(text),
        says,
      );
    }
    await ready(page);
  },
);
