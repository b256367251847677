/** The signs that conversions go by: two variables of the layout, since conversions have no settings of their own. */
import type { ExtensionContext, VariableValue } from '@foxglove/extension';
import type { Signs } from '../messages/scan.ts';

export const AZIMUTH_VARIABLE = 'boresight_azimuth_sign';
export const RANGE_RATE_VARIABLE = 'boresight_range_rate_sign';

type Variables = Readonly<Record<string, VariableValue>>;

let variables: Variables = {};

/** Functions that make aliases are called with the variables whenever these change, in both applications; none is made. */
export function followVariables(context: ExtensionContext): void {
  context.registerTopicAliases?.(({ globalVariables }) => {
    variables = globalVariables as Variables;
    return [];
  });
}

/** -1 where a variable is less than zero. */
const signOf = (value: VariableValue): 1 | -1 => (Number(value) < 0 ? -1 : 1);

/** The signs as the variables say; Lichtblick hands these over with each message. */
export function signs(given: Variables = variables): Signs {
  return { azimuth: signOf(given[AZIMUTH_VARIABLE]), rangeRate: signOf(given[RANGE_RATE_VARIABLE]) };
}
