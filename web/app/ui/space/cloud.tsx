/** A point cloud of a page: from above, or, once it is asked for, in space. */
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../elements/base/define.ts';
import { type PointCloud, PointCloudElement } from '../../../elements/kinds/point-cloud.ts';
import type { CursorPosition } from '../../../plots/types.ts';
import { ElementFrame } from '../plot-frame.tsx';
import type { ColouredBy, SpacePoint } from './points.ts';
import { SPACE_KILOBYTES, SpaceView } from './view.tsx';

defineElement('boresight-point-cloud', PointCloudElement);

interface Props {
  title: string;
  name: string;
  detail: string;
  cloud: PointCloud;
  points: readonly SpacePoint[];
  /** What axes belong to: they only grow until this changes. */
  of: unknown;
  chosen: string | null;
  onChoose(key: string | null): void;
  inSpace: boolean;
  onSwitch(inSpace: boolean): void;
  by: ColouredBy;
  /** What the level of points is, with its unit. */
  level: string;
  onColour(by: ColouredBy): void;
  /** Reach of the view from above, m; as far as there are points where it is not given. */
  range?: number | undefined;
  remarks: readonly string[];
  fileParts?: readonly (string | number)[];
}

/** How far from a detection a click may be, as a share of what is shown. */
const REACH = 0.04;

export function CloudPlot(props: Props) {
  const { title, name, detail, cloud, points, inSpace, range, remarks, fileParts } = props;
  const reach = useMemo(() => Math.max(...points.map(({ xM, yM }) => Math.hypot(xM, yM)), 1), [points]);
  const switcher = (
    <span class="row" slot="actions" role="group" aria-label={`${title}: view`}>
      <button type="button" aria-pressed={!inSpace} data-action="from-above" onClick={() => props.onSwitch(false)}>
        From above
      </button>
      <button
        type="button"
        aria-pressed={inSpace}
        data-action="in-space"
        title={`Opens the 3-D view, for which ${SPACE_KILOBYTES} KB are loaded once`}
        onClick={() => props.onSwitch(true)}
      >
        3-D
      </button>
    </span>
  );
  if (inSpace) return <SpaceView {...props} switcher={switcher} />;
  const pick = ({ x, y }: CursorPosition): void => {
    let best: SpacePoint | null = null;
    let least = 2 * REACH * reach;
    for (const point of points) {
      const apart = Math.hypot(point.yM - x, point.xM - y);
      if (apart < least) [best, least] = [point, apart];
    }
    if (best) props.onChoose(best.key);
  };
  return (
    <ElementFrame
      tag="boresight-point-cloud"
      own={{ points: cloud, boresight: true, range }}
      title={title}
      name={name}
      height="medium"
      detail={detail}
      tools={switcher}
      onClick={pick}
      remarks={remarks}
      {...(fileParts ? { fileParts } : {})}
    />
  );
}
