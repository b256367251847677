/** The topic that a setting means. */
import type { Topic } from '@foxglove/extension';

/** That of the name, or the first where there is no name. */
export const chosen = (fitting: readonly Topic[], name: string): Topic | undefined =>
  name === '' ? fitting[0] : fitting.find((topic) => topic.name === name);
