/** The JSON of mmWave Studio that says what recordings/awr1642/profile.cfg does. */

const chirp = (at, txEnable) => ({
  rlChirpCfg_t: {
    chirpStartIdx: at,
    chirpEndIdx: at,
    profileId: 0,
    startFreqVar_MHz: 0.0,
    freqSlopeVar_KHz_usec: 0.0,
    idleTimeVar_usec: 0.0,
    adcStartTimeVar_usec: 0.0,
    txEnable,
  },
});

/** What recordings/awr1642/profile.cfg says, in the names of mmWaveLink. */
export const studio = () => ({
  configGenerator: { createdBy: 'mmWaveStudio', isConfigIntermediate: 1 },
  currentVersion: { jsonCfgVersion: { major: 0, minor: 4, patch: 0 } },
  mmWaveDevices: [
    {
      mmWaveDeviceId: 0,
      rfConfig: {
        waveformType: 'legacyFrameChirp',
        MIMOScheme: 'TDM',
        rlChanCfg_t: { rxChannelEn: '0xF', txChannelEn: '0x3', cascading: 0, cascadingPinoutCfg: '0x0' },
        rlAdcOutCfg_t: { fmt: { b2AdcBits: 2, b8FullScaleReducFctr: 0, b2AdcOutFmt: 1 } },
        rlProfiles: [
          {
            rlProfileCfg_t: {
              profileId: 0,
              startFreqConst_GHz: 77.0,
              idleTimeConst_usec: 40.0,
              adcStartTimeConst_usec: 7.0,
              rampEndTime_usec: 57.14,
              freqSlopeConst_MHz_usec: 60.0,
              numAdcSamples: 256,
              digOutSampleRate: 5209.0,
              rxGain_dB: '0x1E',
            },
          },
        ],
        rlChirps: [chirp(0, '0x1'), chirp(1, '0x2')],
        rlFrameCfg_t: {
          chirpStartIdx: 0,
          chirpEndIdx: 1,
          numLoops: 16,
          numFrames: 0,
          framePeriodicity_msec: 40.0,
          triggerSelect: 1,
        },
        rlBpmChirps: [],
      },
      rawDataCaptureConfig: {
        rlDevDataFmtCfg_t: { iqSwapSel: 0, chInterleave: 1 },
        rlDevDataPathCfg_t: { intfSel: 1, transferFmtPkt0: '0x1', transferFmtPkt1: '0x0' },
        rlDevLaneEnable_t: { laneEn: '0x3' },
      },
    },
  ],
});
export const setup = { configUsed: 'mine.mmwave.json', captureHardware: 'DCA1000', mmWaveDevice: 'awr1642' };
export const json = (name, value) => ({
  name,
  bytes: Buffer.from(typeof value === 'string' ? value : JSON.stringify(value)),
});
