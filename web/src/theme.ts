/** Light or dark colours: the system's setting or the user's own choice. */
import { effect, signal } from '@preact/signals';

export type Theme = 'system' | 'light' | 'dark';
const kKey = 'theme';
const read = (): Theme => {
  const kept = localStorage.getItem(kKey);
  return kept === 'light' || kept === 'dark' ? kept : 'system';
};

export const theme = signal<Theme>(read());

const dark = window.matchMedia('(prefers-color-scheme: dark)');
const isSystemDark = signal(dark.matches);
dark.addEventListener('change', () => (isSystemDark.value = dark.matches));

effect(() => {
  const system = isSystemDark.value ? 'dark' : 'light';
  document.documentElement.dataset['theme'] = theme.value === 'system' ? system : theme.value;
  localStorage.setItem(kKey, theme.value);
});

const kNext: Record<Theme, Theme> = { system: 'light', light: 'dark', dark: 'system' };
export const nextTheme = (): void => {
  theme.value = kNext[theme.value];
};
