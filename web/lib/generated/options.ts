// Written by `npm run generate` from the descriptions in Rust; not edited by hand.

/**
 * How ESPRIT solves for the rotation.
 *
 * - `least-squares`: Least squares.
 * - `total-least-squares`: Total least squares.
 */
export type EspritForm = 'least-squares' | 'total-least-squares';

/**
 * How IAA treats weak parts of the spectrum (after Rowe, Li and Stoica 2013). What is taken off the powers counts as
 * white noise in the next iteration.
 *
 * - `none`: Plain IAA.
 * - `hard`: Powers below the threshold become zero after each iteration.
 * - `soft`: The threshold is taken off every power after each iteration.
 */
export type Thresholding = 'none' | 'hard' | 'soft';

/**
 * How IAA is computed.
 *
 * - `auto`: Fast where the elements stand on a lattice, else dense.
 * - `fast`: By FFTs; needs a lattice.
 * - `dense`: By matrix products; any array.
 */
export type IaaForm = 'auto' | 'fast' | 'dense';

/**
 * Precision of IAA's fast form.
 *
 * - `auto`: On grids of a power of two single, and double from the first iteration on that needs it to tell angles to
 * 0.001 deg: with strong sources far above the noise. Else double.
 * - `double`: Double throughout.
 */
export type IaaPrecision = 'auto' | 'double';

/** Options of IAA. */
export interface IaaOptions {
  /** Iterations (1 to 10000; default 15). */
  iterations?: number;
  /** Treatment of weak powers (default 'none'). */
  thresholding?: Thresholding;
  /** Threshold below the strongest power (positive) (0 to 300 dB; default 40). */
  thresholdDb?: number;
  /**
   * Noise power added to the diagonal, as a share of the mean element power; 0 for plain IAA (0 to 1000000; default
   * 0).
   */
  regularisation?: number;
  /** Fast or dense (default 'auto'). */
  form?: IaaForm;
  /** Precision of the fast form (default 'auto'). */
  precision?: IaaPrecision;
}

/** Options of NOMP. */
export interface NompOptions {
  /** Probability that noise alone adds a source (1e-12 to 0.5; default 0.01). */
  falseAlarm?: number;
  /** Noise power at one element; estimated from the residual if absent (more than 0). */
  noisePower?: number;
  /** Grid points per element of aperture (1 to 64; default 4). */
  oversampling?: number;
  /** Newton steps on a new source (0 to 100; default 3). */
  singleRefinements?: number;
  /** Rounds of Newton steps over all sources after each new one (0 to 100; default 3). */
  cyclicRefinements?: number;
  /** Most sources (1 to 1024; default 16). */
  maxSources?: number;
}

/** Options of all estimators. Those a method has no use for are ignored. */
export interface SharedEstimatorOptions {
  /** Number of sources, or how they are counted, for methods that need it (1 to 1024; default 'auto'). */
  sources?: number | 'auto' | 'aic' | 'mdl' | 'network';
  /** Half width of the field of view in azimuth (0.1 to 90 deg; default 90). */
  fieldOfViewDeg?: number;
  /** Half width of the field of view in elevation (arrays that span an area) (0.1 to 90 deg; default 30). */
  elevationFieldOfViewDeg?: number;
  /** Points of the azimuth grid, uniform in sin(azimuth) over [-1, 1) (16 to 65536; default 1024). */
  gridPoints?: number;
  /** Points of the elevation grid (arrays that span an area) (3 to 1024; default 61). */
  elevationPoints?: number;
  /**
   * Average the covariance with its reversal, which decorrelates coherent sources (evenly spaced arrays) (default
   * false).
   */
  forwardBackward?: boolean;
  /** Length of the subarrays of spatial smoothing (evenly spaced arrays); none if absent (2 to 1024). */
  smoothing?: number;
  /** Diagonal loading as a share of the mean element power (0 to 1000000; default 0). */
  loading?: number;
  /** Peaks this far below the strongest are not reported (spectral methods) (0.1 to 300 dB; default 20). */
  dynamicRangeDb?: number;
  /** Most sources reported by spectral methods (1 to 1024; default 16). */
  maxPeaks?: number;
  /** How ESPRIT solves for the rotation (default 'total-least-squares'). */
  esprit?: EspritForm;
  /** The iterative adaptive approach. */
  iaa?: IaaOptions;
  /** Newtonized orthogonal matching pursuit, and the search for sources in the atomic norm and in refinement. */
  nomp?: NompOptions;
  /**
   * Refine the sources on the matched model: those that noise explains are dropped, what stands out of the rest is
   * added, and all are taken to the best fit by Gauss-Newton steps, with the false-alarm probability and noise power
   * of `nomp` (default false).
   */
  refine?: boolean;
  /**
   * Power of the array's unknown error over that of each source, for methods that would take it for further sources:
   * NOMP, refinement, and counting. Gains and phases off by 1 dB and 10 deg are -13.6. If absent, what the array's
   * calibration leaves (in the chain), or none (-100 to 0 dB).
   */
  mismatchDb?: number;
  /** A network that has been loaded under this name: the one that a method needs, or a counting network for `sources`. */
  network?: string;
  /** Least confidence of a network's sources; that of its card if absent (0 to 1). */
  confidence?: number;
  /** Most iterations of maximum likelihood and sparse Bayesian learning (1 to 100000; default 200). */
  maxIterations?: number;
  /** Change of angle (rad) or relative change of power at which iterations stop (1e-15 to 1; default 1e-8). */
  tolerance?: number;
}

/**
 * A taper.
 *
 * - `rectangular`: All ones: best resolution, sidelobes at -13 dB.
 * - `hann`: Raised cosine, sidelobes from -31 dB falling 18 dB an octave.
 * - `hamming`: Raised cosine on a pedestal, sidelobes at -43 dB.
 * - `blackman`: Three terms, sidelobes at -58 dB.
 * - `blackman-harris`: Four terms, sidelobes at -92 dB.
 * - `chebyshev`: Dolph-Chebyshev: the narrowest main lobe for sidelobes all at -80 dB.
 * - `taylor`: Taylor: three sidelobes near -40 dB, the others falling.
 */
export type WindowName = 'rectangular' | 'hann' | 'hamming' | 'blackman' | 'blackman-harris' | 'chebyshev' | 'taylor';

/**
 * How noise is estimated from the training cells.
 *
 * - `excision`: The mean of those that are no targets themselves (Goldman and Bar-David 1988): keeps targets apart,
 * and the rate beside them.
 * - `cell-averaging`: The mean of all (Finn and Johnson 1968): the least loss in even noise; a strong target hides a
 * weaker one among whose training cells it is.
 * - `greatest-of`: The larger of the means of the halves (Hansen and Sawyers 1980): keeps the rate at clutter edges.
 * - `smallest-of`: The smaller of the means of the halves (Trunk 1978): keeps targets apart.
 * - `ordered-statistic`: The cell of a rank (Rohling 1983): keeps targets apart and most of the rate.
 */
export type CfarKind = 'excision' | 'cell-averaging' | 'greatest-of' | 'smallest-of' | 'ordered-statistic';

/**
 * Along which axes training cells lie.
 *
 * - `range`: Range only: in a scene that stands still all power lies at zero Doppler, and a window across it would see
 * no noise like the cell's own.
 * - `doppler`: Doppler only.
 * - `both`: A ring around the cell in both.
 */
export type CfarAxes = 'range' | 'doppler' | 'both';

/** How detection works. */
export interface CfarOptions {
  /** The detector of constant false-alarm rate: how it takes the noise from the training cells (default 'excision'). */
  kind?: CfarKind;
  /** Axes along which training cells lie (default 'range'). */
  axes?: CfarAxes;
  /** Probability that a cell of noise becomes a detection (1e-15 to 0.5; default 1e-6). */
  falseAlarm?: number;
  /**
   * Cells left out on each side of the cell under test, along range and Doppler, so that they cover the main lobe
   * (default [4, 2]).
   */
  guardCells?: readonly [number, number];
  /**
   * Cells on each side beyond the guard cells that the noise level is estimated from, along range and Doppler (default
   * [8, 4]).
   */
  trainingCells?: readonly [number, number];
  /** Which of the ordered training cells stands for the noise, as a share of them (0 to 1; default 0.75). */
  rank?: number;
}

/** Limits, both ends inside; absent ones hold nothing back. */
export interface Region {
  /** Least and greatest range. */
  rangeM?: readonly [number, number];
  /** Least and greatest range rate. */
  rateMps?: readonly [number, number];
  /** Least and greatest azimuth (-90 to 90 deg). */
  azimuthDeg?: readonly [number, number];
  /** Least and greatest elevation; arrays that see none have all at 0 (-90 to 90 deg). */
  elevationDeg?: readonly [number, number];
  /** Least and greatest height over the sensor (z). */
  heightM?: readonly [number, number];
}

/**
 * An angle-of-arrival estimator.
 *
 * - `bartlett`: Delay and sum (an FFT on a lattice).
 * - `capon`: Minimum-variance beamformer (Capon 1969).
 * - `music`: Multiple signal classification (Schmidt 1986).
 * - `single-snapshot-music`: MUSIC on a Hankel matrix of one snapshot (Liao and Fannjiang 2016).
 * - `root-music`: Root-MUSIC (Barabell 1983).
 * - `esprit`: Rotational invariance (Roy and Kailath 1989), least squares or total least squares.
 * - `min-norm`: Minimum norm (Kumaresan and Tufts 1983).
 * - `coarray-music`: MUSIC on the difference co-array (Pal and Vaidyanathan 2010): more sources than elements on
 * sparse arrays.
 * - `iaa`: Iterative adaptive approach (Yardibi et al. 2010).
 * - `nomp`: Newtonized orthogonal matching pursuit (Mamandipoor et al. 2016).
 * - `atomic-norm`: Atomic norm minimisation without a grid (Bhaskar et al. 2013).
 * - `maximum-likelihood`: Deterministic maximum likelihood by alternating projection (Ziskind and Wax 1988).
 * - `sparse-bayesian`: Off-grid sparse Bayesian learning (Yang, Xie and Zhang 2013).
 * - `aaetr`: A transformer that answers with a set of targets (AAETR).
 * - `learned-pursuit`: A network without attention that answers with a set of targets: a pursuit whose steps are
 * learned.
 * - `dnn`: A fully connected network on the covariance, of whole degrees (after Chen, Gong and Mao 2020).
 * - `cnn3d`: A convolutional network on a region of the range spectrum, of whole degrees (Sang et al. 2021).
 * - `unrolled-iaa`: UAA: iterations of IAA unrolled into the layers of a network, without matrix inverses (Zheng et
 * al. 2023).
 * - `covariance-cnn`: A convolutional network on the covariance, of sources on a grid (Papageorgiou et al. 2021).
 * - `deep-music`: Convolutional networks on the covariance that answer with MUSIC's spectrum (Elbir 2020).
 */
export type Method =
  | 'bartlett'
  | 'capon'
  | 'music'
  | 'single-snapshot-music'
  | 'root-music'
  | 'esprit'
  | 'min-norm'
  | 'coarray-music'
  | 'iaa'
  | 'nomp'
  | 'atomic-norm'
  | 'maximum-likelihood'
  | 'sparse-bayesian'
  | 'aaetr'
  | 'learned-pursuit'
  | 'dnn'
  | 'cnn3d'
  | 'unrolled-iaa'
  | 'covariance-cnn'
  | 'deep-music';

/** Angle estimation in each cell, on the chain's array. */
export interface AngleOptions {
  /** Method of angle estimation (default 'bartlett'). */
  method?: Method;
  /** Number of sources, or how they are counted, for methods that need it (1 to 1024; default 'auto'). */
  sources?: number | 'auto' | 'aic' | 'mdl' | 'network';
  /** Half width of the field of view in azimuth (0.1 to 90 deg; default 90). */
  fieldOfViewDeg?: number;
  /** Half width of the field of view in elevation (arrays that span an area) (0.1 to 90 deg; default 30). */
  elevationFieldOfViewDeg?: number;
  /** Points of the azimuth grid, uniform in sin(azimuth) over [-1, 1) (16 to 65536; default 1024). */
  gridPoints?: number;
  /** Points of the elevation grid (arrays that span an area) (3 to 1024; default 61). */
  elevationPoints?: number;
  /**
   * Average the covariance with its reversal, which decorrelates coherent sources (evenly spaced arrays) (default
   * false).
   */
  forwardBackward?: boolean;
  /** Length of the subarrays of spatial smoothing (evenly spaced arrays); none if absent (2 to 1024). */
  smoothing?: number;
  /** Diagonal loading as a share of the mean element power (0 to 1000000; default 0). */
  loading?: number;
  /** Peaks this far below the strongest are not reported (spectral methods) (0.1 to 300 dB; default 20). */
  dynamicRangeDb?: number;
  /** Most sources reported by spectral methods (1 to 1024; default 16). */
  maxPeaks?: number;
  /** How ESPRIT solves for the rotation (default 'total-least-squares'). */
  esprit?: EspritForm;
  /** The iterative adaptive approach. */
  iaa?: IaaOptions;
  /** Newtonized orthogonal matching pursuit, and the search for sources in the atomic norm and in refinement. */
  nomp?: NompOptions;
  /**
   * Refine the sources on the matched model: those that noise explains are dropped, what stands out of the rest is
   * added, and all are taken to the best fit by Gauss-Newton steps, with the false-alarm probability and noise power
   * of `nomp` (default false).
   */
  refine?: boolean;
  /**
   * Power of the array's unknown error over that of each source, for methods that would take it for further sources:
   * NOMP, refinement, and counting. Gains and phases off by 1 dB and 10 deg are -13.6. If absent, what the array's
   * calibration leaves (in the chain), or none (-100 to 0 dB).
   */
  mismatchDb?: number;
  /** A network that has been loaded under this name: the one that a method needs, or a counting network for `sources`. */
  network?: string;
  /** Least confidence of a network's sources; that of its card if absent (0 to 1). */
  confidence?: number;
  /** Most iterations of maximum likelihood and sparse Bayesian learning (1 to 100000; default 200). */
  maxIterations?: number;
  /** Change of angle (rad) or relative change of power at which iterations stop (1e-15 to 1; default 1e-8). */
  tolerance?: number;
}

/** How frames become detections. */
export interface DetectionOptions {
  /** Window over the samples of a chirp: lower sidelobes in range for a wider main lobe (default 'hann'). */
  rangeWindow?: WindowName;
  /** Window over the loops of a frame: lower sidelobes in rate for a wider main lobe (default 'hann'). */
  dopplerWindow?: WindowName;
  /** Range bins as a multiple of the samples, a power of two: finer bins, the same resolution (1 to 64; default 1). */
  rangePadding?: number;
  /** Doppler bins as a multiple of the loops, a power of two: finer bins, the same resolution (1 to 64; default 1). */
  dopplerPadding?: number;
  /** Take the mean over the loops off, which removes what does not move (default false). */
  staticClutterRemoval?: boolean;
  /** Detection. Guard and training cells are counted in cells of unpadded transforms. */
  cfar?: CfarOptions;
  /** Keep one detection a peak: of adjacent cells over the threshold, the strongest (default true). */
  peakGrouping?: boolean;
  /**
   * Limits outside which detections are dropped, and counted. Where it names no range, that is from 4 range
   * resolutions to 0.9 of the unambiguous range.
   */
  region?: Region;
  /**
   * Most folds of the range rate to each side that are tried where transmitters take turns: rates beyond the
   * unambiguous one, told by the transmitters' phases. 0 takes every rate for that of its bin (0 to 32; default 0).
   */
  dopplerFolds?: number;
  /** Angle estimation. */
  angle?: AngleOptions;
  /** Most detections a frame; the strongest are kept (1 to 65536; default 256). */
  maxDetections?: number;
}

/**
 * What is estimated.
 *
 * - `channels`: Gain and phase of each channel.
 * - `positions`: These, and where each element is, along the axes the array spans; from targets at several angles.
 * - `coupling`: Gain and phase, and coupling between all channels; from targets at as many known angles as there are
 * channels.
 */
export type CalibrationModel = 'channels' | 'positions' | 'coupling';

/** A target to calibrate by. */
export interface Reflector {
  /** Its range: the strongest cell within two range resolutions is taken (0 to 1000000 m). */
  rangeM: number;
  /** Its azimuth, positive to the left; unknown where absent (-90 to 90 deg). */
  azimuthDeg?: number;
  /** Its elevation, positive upwards; counts with an azimuth (-90 to 90 deg). */
  elevationDeg?: number;
}

/** How an array is calibrated. */
export interface ArrayCalibrationOptions {
  /** What is estimated (default 'channels'). */
  model?: CalibrationModel;
  /** Targets to calibrate by; all strong cells where none are named (default []). */
  reflectors?: readonly Reflector[];
  /**
   * Whether the ranges of the reflectors are exact, so that what measured ranges are too long by can be told (default
   * false).
   */
  rangeBias?: boolean;
  /** Least power of a cell's target in all of its snapshots, over the noise of one (-300 to 300 dB; default 15). */
  minSnrDb?: number;
  /** Most cells; the strongest are taken (1 to 4096; default 64). */
  maxCells?: number;
  /**
   * Greatest power that may be left of a cell once one plane wave is fitted, over that of the cell. Others hold
   * several targets or reflections, and are left out (-100 to 0 dB; default -12).
   */
  maxResidualDb?: number;
}

/** Responses of all channels, measured at known directions, each but for a factor of its own. */
export interface SteeringTable {
  /** Azimuth of each response, positive to the left (-90 to 90 deg). */
  azimuthDeg: Float64Array;
  /** Elevation of each, positive upwards; 0 where absent (-90 to 90 deg). */
  elevationDeg?: Float64Array;
  /** Directions x channels of [re, im], all receivers of a transmitter after each other. */
  responses: readonly (readonly (readonly [number, number])[])[];
}

/**
 * How the mounting angle is estimated.
 *
 * - `weighted-mean`: Weighted mean of the frames' angles, scale taken as 1 (Kellner et al. 2015).
 * - `kabsch`: Rotation between the vehicle's and the radar's velocities (Bao et al. 2020; Kabsch 1976).
 * - `least-squares`: Weighted least squares in angle and inverse scale (Zhu et al., equations 11 to 13).
 * - `orthogonal-distance`: Weighted orthogonal distance regression in angle and inverse scale.
 * - `recursive`: Recursive robust maximum likelihood: one frame at a time, with bias, scale and side slip as further
 * unknowns.
 */
export type CalibrationMethod = 'weighted-mean' | 'kabsch' | 'least-squares' | 'orthogonal-distance' | 'recursive';

/**
 * How the radar's motion is estimated from a frame.
 *
 * - `ransac`: RANSAC, then least squares on the inliers (Kellner et al. 2013).
 * - `weighted-least-squares`: RANSAC, then least squares weighted by each detection's noise.
 * - `orthogonal-distance`: RANSAC, then orthogonal distance regression: azimuths are noisy too.
 * - `tracked`: Robust maximum likelihood led by the frames before, the yaw rate and the angle so far.
 * - `deepego`: A network that weighs the detections of a frame, then weighted least squares (DeepEgo); it needs a file
 * of weights.
 * - `deepego-plus`: The same, smoothed over eight frames by a second network (DeepEgo+), which tells the motion of
 * four frames before; it needs a file of weights.
 */
export type MotionMethod =
  | 'ransac'
  | 'weighted-least-squares'
  | 'orthogonal-distance'
  | 'tracked'
  | 'deepego'
  | 'deepego-plus';

/**
 * What frames weigh in the weighted mean.
 *
 * - `direction`: The inverse variance of the direction of motion.
 * - `motion`: The inverse of the summed variances of both components of the motion (Zhu et al., equation 13).
 * - `equal`: All the same (Zhu et al., equation 8).
 */
export type FrameWeights = 'direction' | 'motion' | 'equal';

/**
 * Options of all methods. Those a method has no use for are ignored. The car's frame is centred on the rear axle, x
 * forward, y left; angles are positive to the left.
 */
export interface CalibrationOptions {
  /** How the angle is estimated. */
  method: CalibrationMethod;
  /**
   * How the motion is estimated; by default in the way that belongs to the method: RANSAC for the mean and Kabsch, its
   * weighted forms for the regressions, tracking for the recursive one.
   */
  motion?: MotionMethod;
  /** What frames weigh in the weighted mean; the other methods weigh them in their own way (default 'direction'). */
  frameWeights?: FrameWeights;
  /** The radar's place ahead of the rear axle (-100 to 100 m). */
  xM: number;
  /** The radar's place left of the centre line (-100 to 100 m; default 0). */
  yM?: number;
  /**
   * The angle the radar should be mounted at, if known: where the search begins, and what the alarm compares with
   * (-180 to 180 deg).
   */
  nominalDeg?: number;
  /**
   * The alarm is raised where the angle differs from nominal by more than this, beyond chance (1e-9 to 180 deg;
   * default 1).
   */
  alarmDeg?: number;
  /** Standard deviation below which the estimate may count as converged (1e-9 to 180 deg; default 0.1). */
  convergedDeg?: number;
  /** Standard deviation of a detection's range rate (more than 0 m/s; default 0.1). */
  rangeRateSigmaMps?: number;
  /** Standard deviation of a detection's azimuth (0 to 180 deg; default 0.5). */
  azimuthSigmaDeg?: number;
  /**
   * Standard deviation of what all azimuths of the radar, and the way the car points as it goes straight, are off by,
   * beyond the mounting: no drive tells it from the angle (0 to 180 deg; default 0.045).
   */
  azimuthBiasSigmaDeg?: number;
  /**
   * Standard deviation of what detections that move and pass for static would turn the angle by if all moved; it
   * counts by the share of detections that do (0 to 180 deg; default 0.15).
   */
  trafficSigmaDeg?: number;
  /**
   * Standard deviation of the error that the angles of all frames within five seconds and fifty metres share, before
   * the drive tells it (more than 0 deg; default 0.1).
   */
  lastingSigmaDeg?: number;
  /** Standard deviation of the yaw rate's bias before anything is known of it (more than 0 deg/s; default 0.1). */
  biasSigmaDegps?: number;
  /** Standard deviation of the yaw rate's scale before anything is known of it (more than 0; default 0.02). */
  scaleSigma?: number;
  /**
   * Slip angle of the rear axle over lateral acceleration that is expected, rad/(m/s^2), outside Rust in degrees (-5
   * to 5 deg; default 0.2).
   */
  slipGradientDeg?: number;
  /** Its standard deviation before anything is known of it (more than 0 deg; default 0.15). */
  slipGradientSigmaDeg?: number;
  /** How long before its time stamp a scan is expected to have been measured (-1 to 1 s; default 0.04). */
  delayS?: number;
  /** Its standard deviation before anything is known of it (more than 0 s; default 0.03). */
  delaySigmaS?: number;
  /**
   * Time of driving after which what was seen counts for a third (recursive method) (60 to 1000000000 s; default
   * 3600).
   */
  memoryS?: number;
  /** Frames below this speed of the radar are left out (0 to 1000 m/s; default 1). */
  minSpeedMps?: number;
  /** Frames turning faster than this are left out (0.1 to 180 deg/s; default 140). */
  maxYawRateDegps?: number;
  /**
   * RANSAC takes a detection as an inlier where its range rate is within this of the fitted curve (more than 0 m/s;
   * default 0.3).
   */
  inlierResidualMps?: number;
  /** Weight from which a detection is an inlier (IT) (0 to 1; default 0.5). */
  inlierThreshold?: number;
  /** Frames with a smaller share of inliers are left out (IRT) (0 to 1; default 0.3). */
  inlierRatioThreshold?: number;
  /** Frames with fewer inliers are left out (3 to 1000000; default 5). */
  minInliers?: number;
  /** Probability that RANSAC draws a pair of inliers at least once (0 to 1; default 0.999). */
  confidence?: number;
  /** Largest gap in the yaw rate over which it is interpolated (more than 0 s; default 0.25). */
  maxGapS?: number;
  /** Seed of RANSAC's draws (default 0). */
  seed?: number | bigint;
}

/**
 * Whether drives share an unknown.
 *
 * - `shared`: One for all drives, about which a drive's own lies as far off as the drives prove to.
 * - `drive`: One a drive, each with the prior by itself.
 */
export type Sharing = 'shared' | 'drive';

/** What to take the unknowns of a vehicle's drives for. */
export interface MergeOptions {
  /** Scale of the yaw rate (default 'shared'). */
  scale?: Sharing;
  /** Bias of the yaw rate (default 'drive'). */
  bias?: Sharing;
  /** Slip gradient of the rear axle (default 'shared'). */
  slip?: Sharing;
  /** Delay of the radars (default 'shared'). */
  delay?: Sharing;
  /**
   * Standard deviation, before the drives tell it, of what a radar's angle is off by in one drive and not in another:
   * load, tyre pressures, weather, and how straight the car goes (more than 0 deg; default 0.03).
   */
  driveSigmaDeg?: number;
}

/** Options of what the records of a fleet come to. */
export interface FleetOptions {
  /**
   * The alarm is raised where an angle differs from nominal by more than this, beyond chance (1e-9 to 180 deg; default
   * 1).
   */
  alarmDeg?: number;
  /** Share of radars without a knock in which one is told (1e-9 to 0.5; default 0.001). */
  knockChance?: number;
  /** Share of radars without a drift in which one is told (1e-9 to 0.5; default 0.001). */
  driftChance?: number;
  /** Knocks and drifts that change the angle by less, over all drives, are not told (0 to 180 deg; default 0.05). */
  leastChangeDeg?: number;
  /** What the drives of a vehicle have in common. */
  joint?: MergeOptions;
}

/**
 * Roads and traffic of a drive.
 *
 * - `city`: Streets with junctions, roundabouts, lights, parked cars, pedestrians.
 * - `country-road`: Curves between fields and woods, oncoming traffic.
 * - `motorway`: Up to 130 km/h between guard rails.
 * - `car-park`: Tight turns between parked cars, forward and in reverse.
 * - `stop-and-go`: A queue on a city road.
 * - `dense-traffic`: Vehicles on all sides at nearly the car's speed.
 */
export type DriveScenario = 'city' | 'country-road' | 'motorway' | 'car-park' | 'stop-and-go' | 'dense-traffic';

/**
 * What the errors of radars and car are like.
 *
 * - `clean`: White noise as the options say, and a few false detections: isolates what an estimator does.
 * - `radarscenes`: Dense scans with lasting errors, heights, ghosts, slip and delay, as in `RadarScenes`.
 */
export type DriveProfile = 'clean' | 'radarscenes';

/** A radar of a simulated drive. */
export interface PlacedRadar {
  /** Its number. */
  id: number;
  /** Ahead of the rear axle. */
  xM: number;
  /** Left of the centre line. */
  yM: number;
  /** Direction of boresight, counter-clockwise from the car's x. */
  yawDeg: number;
}

/** How well a radar measures. */
export interface RadarNoise {
  /** Standard deviation of azimuth at boresight (0 to 10 deg; default 0.35). */
  azimuthSigmaDeg?: number;
  /** Growth of it: `sigma (1 + growth (azimuth / 60 deg)^2)` (0 to 20; default 2). */
  azimuthGrowth?: number;
  /** Standard deviation of range rate (0 to 5 m/s; default 0.05). */
  rangeRateSigmaMps?: number;
  /** Standard deviation of range (0 to 5 m; default 0.1). */
  rangeSigmaM?: number;
  /**
   * Length of the interval a range rate is measured over. It ends at the scan's time stamp; each detection has the
   * range rate of a random instant within (0 to 0.07 s; default 0.04).
   */
  coherentIntervalS?: number;
  /** Share of detections of standing things that get a random range rate (multipath) (0 to 0.5; default 0.012). */
  ghostShare?: number;
  /** Mean number of false detections a scan (0 to 50; default 0.5). */
  clutter?: number;
}

/**
 * What measures the yaw rate.
 *
 * - `navigation`: An integrated navigation system: scale within 0.2 %, hardly any bias.
 * - `series`: A series sensor: scale from 0.98 to 1.02, bias from -0.2 to 0.2 deg/s that walks.
 */
export type YawRateSensor = 'navigation' | 'series';

/** A drive to simulate. */
export interface SimulateDriveOptions {
  /** Roads and traffic (default 'city'). */
  scenario?: DriveScenario;
  /** What the errors of radars and car are like (default 'clean'). */
  profile?: DriveProfile;
  /** Everything random comes from it (default 0). */
  seed?: number | bigint;
  /** The car, by which drives of the profile "radarscenes" share azimuth biases and slip (default 0). */
  car?: number | bigint;
  /**
   * Length of the drive; four radars for an hour at most, or as much by fewer; in the profile "radarscenes" for twenty
   * minutes (1 to 7200 s; default 60).
   */
  durationS?: number;
  /** The radars by number, where they truly sit and look; those of RadarScenes if absent. */
  sensors?: readonly PlacedRadar[];
  /** By how much a radar's true yaw exceeds the one the log states, by its number; zero for radars not named. */
  misalignmentDeg?: { readonly [sensor: number]: number };
  /**
   * Share of moving detections over the scans taken at more than 1 m/s, by leaving out whole movers or detections of
   * standing things. If absent, what the scenario's traffic gives; in the profile "radarscenes", where front radars
   * see more of it than the sides, as scenes have it (0 to 0.8).
   */
  movingShare?: number;
  /** How well radars measure; the profile "radarscenes" has numbers of its own. */
  noise?: RadarNoise;
  /**
   * What measures the yaw rate, where scale, bias and noise are not given. If absent, a series sensor of constant
   * bias, and in the profile "radarscenes" navigation.
   */
  yawRateSensor?: YawRateSensor;
  /** Measured over true yaw rate; drawn as the sensor has it if absent, from 0.98 to 1.02 in series (0.5 to 2). */
  yawRateScale?: number;
  /**
   * Yaw rate measured at standstill; drawn as the sensor has it if absent, from -0.2 to 0.2 deg/s in series (-50 to 50
   * deg/s).
   */
  yawRateBiasDegps?: number;
  /**
   * Standard deviation of a sample's white noise; if absent 0.03 deg/s of navigation, and drawn from 0.07 to 0.13
   * deg/s in series (0 to 50 deg/s).
   */
  yawRateSigmaDegps?: number;
  /** Measured over true speed; if absent 1, and drawn in the profile "radarscenes" (0.5 to 2). */
  speedScale?: number;
  /** Standard deviation of a sample of speed; 0.03 m/s if absent. At standstill the speed reads zero (0 to 5 m/s). */
  speedSigmaMps?: number;
  /**
   * Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outside Rust in degrees; outwards, as tyres
   * slip. If absent 0, and drawn in the profile "radarscenes" (-1 to 1 deg).
   */
  slipGradientDeg?: number;
}

/**
 * Order of I and Q in a capture.
 *
 * - `configured`: As the configuration says; a remark tells where the data contradict.
 * - `auto`: As the data tell; as the configuration says where they do not.
 * - `iq`: I first.
 * - `qi`: Q first.
 */
export type IqOrder = 'configured' | 'auto' | 'iq' | 'qi';

/**
 * Lanes over which a board of one chip hands its samples to the capture card.
 *
 * - `configured`: As the configuration says.
 * - `two`: Two: receivers one after another.
 * - `four`: Four: receivers sample by sample.
 */
export type Lanes = 'configured' | 'two' | 'four';

/** How the samples of a capture are read, where its configuration does not say so or says it wrong. */
export interface ReadingOptions {
  /** Order of I and Q (default 'configured'). */
  iqOrder?: IqOrder;
  /** Lanes of the board (default 'configured'). */
  lanes?: Lanes;
}

/** How much a region of interest holds; what the 3D-CNN paper (Sang et al. 2021) takes unless said otherwise. */
export interface RegionOptions {
  /** Range bins, the strongest in their middle (at least 1; default 65). */
  bins?: number;
  /** Chirps of each transmitter, from the first of the frame (at least 1; default 4). */
  chirps?: number;
}

/**
 * When a region is turned to its coarse angle, so that what was made for a sector about boresight applies anywhere.
 *
 * - `never`: Never, as in the paper.
 * - `outside`: Where the coarse angle lies outside the sector.
 * - `always`: Always.
 */
export type Rotation = 'never' | 'outside' | 'always';

/** How frames become regions, and these targets. */
export interface RegionChainOptions {
  /** Range bins, the strongest in their middle (at least 1; default 65). */
  bins?: number;
  /** Chirps of each transmitter, from the first of the frame (at least 1; default 4). */
  chirps?: number;
  /**
   * Range bins on each side of a region's middle that count; bins beyond are set to zero, and peaks there begin
   * regions of their own. All that the region holds if absent.
   */
  reachBins?: number;
  /** Window over the samples of a chirp for detection (default 'hann'). */
  rangeWindow?: WindowName;
  /** Window over the samples of a chirp for what networks take; they were trained without (default 'rectangular'). */
  regionWindow?: WindowName;
  /**
   * Diagonal loading of the covariance that targets are counted in, as a share of the mean element power. Arrays that
   * differ from their drawing need it, since a network trained on exact ones takes the difference for a target (0 to
   * 1000000; default 0).
   */
  countLoading?: number;
  /** Detection on the power over range, mean over elements and chirps. Training cells always lie along range. */
  cfar?: CfarOptions;
  /**
   * Limits outside which peaks make no region; the angle's hold for targets. Where they name no range, that is from 4
   * range resolutions to 0.9 of the unambiguous range.
   */
  region?: Region;
  /** Whether regions are turned to their coarse angle (default 'outside'). */
  rotation?: Rotation;
  /**
   * Half width of the sector about boresight in which a region is not turned unless it always is (0 to 90 deg; default
   * 10.5).
   */
  sectorDeg?: number;
  /**
   * Refine the angles on the matched model, beyond whole degrees; those that noise explains are dropped (default
   * false).
   */
  refine?: boolean;
  /** Probability that noise alone adds a target to a region (joint estimation) (1e-12 to 0.5; default 0.01). */
  falseAlarm?: number;
  /**
   * Power of unknown array errors relative to each target, which joint estimation does not report as further targets.
   * Gain errors of 1 dB and phase errors of 10 deg give -13.6. Default: the residual of the array's calibration, or
   * none (-100 to 0 dB).
   */
  mismatchDb?: number;
  /** Most regions a frame; those with the strongest peaks are kept (1 to 1024; default 32). */
  maxRegions?: number;
}

/** What a street is made from. */
export interface StreetOptions {
  /**
   * The things in it come from stream 0 of this seed, the cube of radar `i` from one that stream `i + 1` gives
   * (default 0).
   */
  seed?: number | bigint;
  /**
   * Speed of the car along x. The faster it is, the farther Doppler tells apart what stands at one range in different
   * directions (-30 to 30 m/s; default 6).
   */
  egoSpeedMps?: number;
}

/**
 * How amplitudes change from snapshot to snapshot.
 *
 * - `random-phase`: Constant magnitude, a new phase for each target and snapshot: uncorrelated targets of exactly the
 * given powers.
 * - `complex-normal`: A new complex normal amplitude of the given mean power for each target and snapshot: the
 * stochastic model of the bounds.
 * - `coherent`: Constant magnitude, a new phase for each snapshot that all targets share: fully correlated targets.
 */
export type Fluctuation = 'random-phase' | 'complex-normal' | 'coherent';

/** Errors of an array's elements, drawn from normal distributions. */
export interface Imperfections {
  /** Standard deviation of the gain of the elements (0 to 100 dB; default 0). */
  gainDb?: number;
  /** Standard deviation of the phase of the elements (0 to 3600 deg; default 0). */
  phaseDeg?: number;
  /** Standard deviation of the displacement of the elements along y, half wavelengths (0 to 100; default 0). */
  position?: number;
  /**
   * Coupling between elements half a wavelength apart; falls with the square of the distance, with the phase of its
   * travel. No coupling if absent (-200 to 0 dB).
   */
  couplingDb?: number;
  /** Seed they are drawn from; that of the simulation if absent. */
  seed?: number | bigint;
}

/** Snapshots of scenes, whose array and targets are given beside it. */
export interface SnapshotRequest {
  /**
   * Power of a 0 dB target at one element over noise power at one element: noise power is `10^(-snr_db / 10)` (-300 to
   * 300 dB; default 20).
   */
  snrDb?: number;
  /** Snapshots a scene (at least 1; default 1). */
  snapshots?: number;
  /** How amplitudes change between them (default 'random-phase'). */
  fluctuation?: Fluctuation;
  /**
   * Wavelength, which says how long a half wavelength of the positions is; of use for targets with a range (1e-6 to
   * 1000 m; default 0.0039).
   */
  wavelengthM?: number;
  /**
   * Seed; the same one gives the same numbers on every machine. Scene `i` draws from stream `i` of it, whatever else
   * is simulated.
   */
  seed: number | bigint;
  /** Scenes (default 1). */
  scenes?: number;
  /** Number of the first scene, to split a sweep (default 0). */
  firstScene?: number;
  /** Errors of the array's elements. */
  imperfections?: Imperfections;
}

/** Something that reflects. */
export interface SnapshotTarget {
  /** Azimuth, counter-clockwise from boresight (positive to the left) (-90 to 90 deg; default 0). */
  azimuthDeg?: number;
  /** Elevation, positive upwards (-90 to 90 deg; default 0). */
  elevationDeg?: number;
  /** Its power at one element, `20 log10` of its amplitude (-300 to 300 dB; default 0). */
  powerDb?: number;
  /** Phase of its amplitude in the first snapshot; drawn uniformly if absent. Complex normal amplitudes have none. */
  phaseDeg?: number;
  /**
   * Distance from the array's origin: its wave is spherical, with the paths of each transmitter and receiver, and
   * equally strong at all elements. Without it the wave is plane (0.001 to 1000000000 m).
   */
  rangeM?: number;
}

/** Rule by which scenes are drawn: every quantity uniform. */
export interface SceneSampling {
  /** Fewest and most targets (default [0, 16]). */
  count?: readonly [number, number];
  /** Azimuths lie within plus and minus this (0 to 90 deg; default 60). */
  fieldOfViewDeg?: number;
  /** Elevations lie within plus and minus this; 0 keeps targets in the horizontal plane (0 to 90 deg; default 0). */
  elevationFieldOfViewDeg?: number;
  /** Lowest and highest power (default [-13, 0]). */
  powerDb?: readonly [number, number];
}

/**
 * How the power of each reflection fluctuates about its mean. Phases stay as they are.
 *
 * - `steady`: Not at all.
 * - `swerling1`: Exponential power, as of many scatterers alike, new in each frame.
 * - `swerling2`: The same, new in each chirp.
 * - `swerling3`: Power of a chi-squared distribution of four degrees of freedom, as of one large scatterer among many,
 * new in each frame.
 * - `swerling4`: The same, new in each chirp.
 */
export type SwerlingModel = 'steady' | 'swerling1' | 'swerling2' | 'swerling3' | 'swerling4';

/** A flat road that reflects. */
export interface Ground {
  /** Height of the radar over it (0.01 to 100 m). */
  radarHeightM?: number;
  /** Amplitude of the reflection over that of the incident wave. Its phase is reversed (0 to 1). */
  reflection?: number;
}

/** Another radar that transmits. */
export interface Interferer {
  /** Azimuth, counter-clockwise from boresight (positive to the left) (-90 to 90 deg). */
  azimuthDeg?: number;
  /** Elevation, positive upwards (-90 to 90 deg). */
  elevationDeg?: number;
  /** Power of one raw sample at one element, while it is in the band (-200 to 200 dB). */
  powerDb?: number;
  /** Frequency at which its ramps start (1000000 to 1000000000000 Hz). */
  startFrequencyHz?: number;
  /** Slope of its ramps (-1e+16 to 1e+16 Hz/s). */
  slopeHzPerS?: number;
  /** Length of a ramp (1e-9 to 1 s). */
  rampS?: number;
  /** Time from one ramp to the next (1e-9 to 1 s). */
  intervalS?: number;
  /** Time of its first ramp after the start of the first chirp (-1 to 1 s). */
  delayS?: number;
}

/** A data cube, whose waveform, array and targets are given beside it. */
export interface CubeRequest {
  /** Power of a 0 dB target over noise power, both of one raw sample (-200 to 300 dB; default 20). */
  snrDb?: number;
  /** Frames (at least 1; default 1). */
  frames?: number;
  /** Fluctuation of the targets' reflections (default 'steady'). */
  fluctuation?: SwerlingModel;
  /**
   * Phase noise of the oscillator in 1 Hz, 1 MHz from the carrier, over the carrier; it falls by 20 dB a decade. None
   * if absent (-200 to -40 dB).
   */
  phaseNoiseDb?: number;
  /** A road that reflects; none if absent. */
  ground?: Ground;
  /** Other radars that interfere (default []). */
  interferers?: readonly Interferer[];
  /**
   * Seed; the same one gives the same numbers on every machine. Reflection phases come from stream 0 of it, the noise
   * of frame `i` from stream `i + 1`.
   */
  seed: number | bigint;
  /** Spherical wavefronts instead of plane ones (default false). */
  nearField?: boolean;
  /** Errors of the array's elements. */
  imperfections?: Imperfections;
}

/** A point target that moves along the line of sight. */
export interface CubeTarget {
  /** Distance from the array's origin at the start of the first chirp. */
  rangeM: number;
  /** Rate at which the range grows (-100000 to 100000 m/s). */
  rateMps?: number;
  /** Azimuth, counter-clockwise from boresight (positive to the left) (-90 to 90 deg). */
  azimuthDeg?: number;
  /** Elevation, positive upwards (-90 to 90 deg). */
  elevationDeg?: number;
  /** Power of one raw sample at one element (-200 to 200 dB). */
  powerDb?: number;
  /** Phase of its reflection; drawn from the seed if absent. */
  phaseDeg?: number;
}

/**
 * What a bound holds the signals for.
 *
 * - `deterministic`: Unknown constants.
 * - `stochastic`: Gaussian, of unknown covariance.
 */
export type BoundKind = 'deterministic' | 'stochastic';

/** Data that a bound is of, beside array and targets. */
export interface BoundRequest {
  /** Snapshots (at least 1). */
  snapshots: number;
  /** What it holds the signals for (default 'deterministic'). */
  kind?: BoundKind;
}

/** A target of a bound. */
export interface BoundTarget {
  /** Azimuth, counter-clockwise from boresight (positive to the left) (-90 to 90 deg). */
  azimuthDeg?: number;
  /** Elevation, positive upwards (-90 to 90 deg). */
  elevationDeg?: number;
  /** Its power over that of the noise, at one element (-300 to 300 dB). */
  snrDb: number;
  /** Phase of its amplitude; counts for the deterministic bound of a single snapshot. */
  phaseDeg?: number;
}

/** Grid of a range-azimuth map. */
export interface MapGrid {
  /** First and last range (0 to 1000000 m). */
  rangeM: readonly [number, number];
  /** Points in range (2 to 16384). */
  ranges: number;
  /** Half width of the field of view (0.1 to 90 deg). */
  fieldOfViewDeg: number;
  /** Points in azimuth, uniform in its sine (2 to 16384). */
  azimuths: number;
}

/** Grid of a bird's-eye view in the car's frame. */
export interface ViewGrid {
  /** Edges ahead (positive) and behind (default [-20, 80]). */
  xM?: readonly [number, number];
  /** Edges right (negative) and left (default [-25, 25]). */
  yM?: readonly [number, number];
  /** Width of a cell, and so of a pixel (0.001 to 1000 m; default 0.2). */
  cellM?: number;
}

/**
 * How sources are counted by eigenvalues.
 *
 * - `largest-root`: Test by test whether the largest eigenvalue left is more than noise makes, at a false-alarm
 * probability. Valid from two vectors on.
 * - `aic`: Akaike's information criterion: `2 L(k) + 2 p(k)`. Counts too many, with few vectors by far.
 * - `mdl`: Rissanen's and Schwarz's minimum description length: `L(k) + p(k) ln(N) / 2`. Consistent, but counts far
 * too many where there are about as many vectors as elements.
 */
export type Criterion = 'largest-root' | 'aic' | 'mdl';

/** How sources are counted. */
export interface CountOptions {
  /** How sources are counted (default 'largest-root'). */
  criterion?: Criterion;
  /** Probability that the largest-root test takes noise for a source (1e-12 to 0.5; default 0.01). */
  falseAlarm?: number;
  /** Average the covariance with its reversal, for evenly spaced arrays (default false). */
  forwardBackward?: boolean;
  /**
   * Power of the array's unknown error over that of each source: further eigenvalues that it explains are no sources.
   * None if absent (-100 to 0 dB).
   */
  mismatchDb?: number;
}

/**
 * A format of drive logs.
 *
 * - `radarscenes`: [`crate::radarscenes`]: `radar_data.h5` of a sequence.
 * - `delphi`: [`delphi`]: tracks of a Delphi front radar and poses.
 * - `csv`: [`table`]: the general tables.
 * - `pcd`: Point clouds, a file a scan, as of nuScenes and TruckScenes.
 * - `view-of-delft`: Frames of View-of-Delft.
 * - `mcap`: Recordings of ROS and others in MCAP.
 */
export type DriveFormat = 'radarscenes' | 'delphi' | 'csv' | 'pcd' | 'view-of-delft' | 'mcap';

/**
 * Which side azimuths are positive on.
 *
 * - `left`: Positive to the left, counter-clockwise seen from above: nothing is changed.
 * - `right`: Positive to the right: all are turned round.
 * - `auto`: As the drive tells: turned round where it is certain that they are positive to the right.
 */
export type AzimuthSign = 'left' | 'right' | 'auto';

/**
 * When range rates are positive.
 *
 * - `receding`: Positive when receding: nothing is changed.
 * - `approaching`: Positive when approaching, as a Doppler frequency: all are turned round.
 * - `auto`: As the drive tells: turned round where it is certain that they are positive when approaching.
 */
export type RangeRateSign = 'receding' | 'approaching' | 'auto';

/** How a drive is read. */
export interface ReadDriveOptions {
  /** The format of the files; found from their contents where none is named. */
  format?: DriveFormat;
  /** The side on which azimuths are positive (default 'left'). */
  azimuthSign?: AzimuthSign;
  /** When range rates are positive (default 'receding'). */
  rangeRateSign?: RangeRateSign;
  /**
   * Topics of radars in an MCAP file; by default all with detections, and those with tracks where there are no others
   * (default []).
   */
  radarTopics?: readonly string[];
  /**
   * Topics of the car's motion in an MCAP file; by default one with the speed, and one with the yaw rate alone if
   * there is one (default []).
   */
  motionTopics?: readonly string[];
  /** Frame of the car, centred on the rear axle, in which an MCAP file states where radars sit; base_link by default. */
  baseFrame?: string;
}

/** Which array of a file is read. */
export interface ReadArrayOptions {
  /** Its name, with those of its groups before it and `/` between; needed where the file has several. */
  dataset?: string;
}

/** What one call may take. */
export interface Limits {
  /**
   * Operations (complex multiplications): 1e10 take some ten seconds in a page; the largest number for no limit (at
   * least 1; default 10000000000).
   */
  operations?: number;
  /** Memory of what a call makes, in bytes (a gibibyte) (at least 1; default 1073741824). */
  bytes?: number;
}
