/** The configuration that a board is to run, as it stands in its field. */
import { computed, signal } from '@preact/signals';
import type { RadarConfig } from 'boresight';
import cfgAddress from '../../../../recordings/awr1642/profile.cfg?url';
import { api, describeError, type Problem } from '../../data.ts';
import { fetched } from '../mounting/drive/drive.ts';

export interface Profile {
  name: string;
  text: string;
}

export const profile = signal<Profile | null>(null);

/** What it says, or what is wrong with it. */
export const parsed = computed((): { config: RadarConfig } | { problem: Problem } | null => {
  const given = profile.value;
  if (!given?.text.trim()) return null;
  try {
    return { config: api.parseConfig(given.text) };
  } catch (error) {
    return { problem: describeError(error) };
  }
});

export const config = computed(() => (parsed.value && 'config' in parsed.value ? parsed.value.config : null));

export async function loadBundledProfile(signal?: AbortSignal): Promise<Profile> {
  const bytes = await fetched('profile.cfg', cfgAddress, signal ?? new AbortController().signal);
  const bundled = { name: 'profile.cfg', text: new TextDecoder().decode(bytes) };
  profile.value = bundled;
  return bundled;
}
