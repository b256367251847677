import { controlOf } from '../../ui/control.tsx';
import { mountingCodec, mountingState, update } from './state.ts';

export const Control = controlOf(mountingCodec, mountingState, update);
