/** The parts of the page for a live server, which come when one is first chosen. */
import { signal } from '@preact/signals';
import type { ComponentType } from 'preact';
import { useEffect } from 'preact/hooks';

type Parts = Record<'Source' | 'Place' | 'View', ComponentType>;

const parts = signal<Parts | null>(null);
const failed = signal(false);

async function load(): Promise<void> {
  failed.value = false;
  try {
    const [{ Source }, { Place }, { View }] = await Promise.all([
      import('./source.tsx'),
      import('./place.tsx'),
      import('./view.tsx'),
    ]);
    parts.value = { Source, Place, View };
  } catch (error) {
    failed.value = true;
    console.error(error);
  }
}

export function Live({ part }: { part: keyof Parts }) {
  useEffect(() => {
    if (!parts.peek()) void load();
  }, []);
  const Part = parts.value?.[part];
  if (Part) return <Part />;
  if (!failed.value || part !== 'View') return null;
  return (
    <p class="alert" role="alert">
      This part of the page could not be loaded.{' '}
      <button type="button" onClick={() => void load()}>
        Try again
      </button>
    </p>
  );
}
