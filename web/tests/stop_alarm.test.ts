import { h, render } from 'preact';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import type { Rig } from '../src/api/types';
import { nextAlarm } from '../src/model/stop_alarm';
import { TinyNode, tinyDocument } from './tiny_dom';

vi.mock('../src/api/services', () => ({ lease: {}, rig: {}, session: {} }));

/** The page's Web Audio: `running` are the contexts that have not been closed. */
const audio = { running: 0, resumed: 0, oscillators: 0 };
class TinyNodeOfAudio {
  gain = this;
  connect = (to: unknown) => to;
  start = () => (audio.oscillators += 1);
}
class TinyAudioContext {
  constructor() {
    audio.running += 1;
  }
  // As in a browser before the first gesture.
  resume = () => {
    audio.resumed += 1;
    return Promise.reject(new Error('not allowed'));
  };
  close = () => (audio.running -= 1);
}

const listeners = new Map<string, () => void>();
vi.stubGlobal('AudioContext', TinyAudioContext);
vi.stubGlobal('OscillatorNode', TinyNodeOfAudio);
vi.stubGlobal('GainNode', TinyNodeOfAudio);
vi.stubGlobal('localStorage', { getItem: () => null, setItem: () => {}, removeItem: () => {} });
vi.stubGlobal('document', { ...tinyDocument, addEventListener: () => {} });
vi.stubGlobal('window', {
  addEventListener: (kind: string, listener: () => void) => listeners.set(kind, listener),
  removeEventListener: (kind: string) => listeners.delete(kind),
  setInterval: () => 0,
  setTimeout: () => 0,
});

const { show } = await import('../src/state/rig');
const { StopAlarm } = await import('../src/screens/stop_alarm');
const { DriveAlarm } = await import('../src/screens/rig/drive_alarm');

const kIgnored = { state: 'STOPPING', cause: 'STOP_NOT_OBEYED' } as Rig;
const kAtRest = { ...kIgnored, state: 'FAULT' } as Rig;
const kIdle = { state: 'IDLE', cause: '' } as Rig;
const kOtherFault = { state: 'FAULT', cause: 'LINK_LOST' } as Rig;

describe('the alarm', () => {
  test.each([
    ['is loud for a page that opens while the cause stands', 'off', undefined, kAtRest, 'loud'],
    ['is loud once the cause appears', 'off', { ...kIgnored, cause: '' }, kIgnored, 'loud'],
    ['stays loud while the axis comes to rest', 'loud', kIgnored, kAtRest, 'loud'],
    ['stays acknowledged', 'acknowledged', kIgnored, kAtRest, 'acknowledged'],
    ['stays acknowledged while the link is lost', 'acknowledged', kAtRest, kAtRest, 'acknowledged'],
    ['is loud again if the axis moves again', 'acknowledged', kAtRest, kIgnored, 'loud'],
    ['replaces another cause', 'off', kOtherFault, kIgnored, 'loud'],
    ['ends with its cause', 'loud', kIgnored, kOtherFault, 'off'],
    ['ends with its cause, also when acknowledged', 'acknowledged', kAtRest, kIdle, 'off'],
    ['is off for other causes', 'off', kIdle, kOtherFault, 'off'],
  ] as const)('%s', (_, alarm, before, now, next) => {
    expect(nextAlarm(alarm, before as Rig | undefined, now as Rig)).toBe(next);
  });
});

describe('the page', () => {
  const page = new TinyNode(1, 'body');
  const updated = async () => {
    for (let i = 0; i < 20; i += 1) await Promise.resolve();
  };
  const shows = async (state: Rig) => {
    show(state);
    await updated();
  };
  const acknowledge = async () => {
    page.find('button')!.fire('click');
    await updated();
  };

  beforeEach(async () => {
    Object.assign(audio, { running: 0, resumed: 0, oscillators: 0 });
    await shows(kIdle);
    render(h(StopAlarm, {}), page as unknown as Element);
  });
  afterEach(async () => {
    await shows(kIdle);
    render(null, page as unknown as Element);
  });

  test('shows nothing and is silent while stops are obeyed', async () => {
    await shows(kOtherFault);
    expect(page.text).toBe('');
    expect(audio.running).toBe(0);
  });

  test('shows a modal alert, focused but not on its button, and sounds', async () => {
    await shows(kIgnored);
    const dialog = page.find('dialog')!;
    expect(dialog.attribute('role')).toBe('alertdialog');
    expect(dialog.open).toBe(true);
    expect(page.text).toContain('Press the stop button on the rig');
    expect(page.text).toMatch(/reset, arm and home/);
    expect(TinyNode.focused).toBe(page.find('h1'));
    expect(audio).toMatchObject({ running: 1, oscillators: 2 });
  });

  test('tries to sound again at every gesture, because the browser may have refused', async () => {
    await shows(kIgnored);
    expect(audio.resumed).toBe(1);
    listeners.get('pointerdown')!();
    listeners.get('keydown')!();
    expect(audio.resumed).toBe(3);
  });

  test('opens the alert again if the browser closes it', async () => {
    await shows(kIgnored);
    page.find('dialog')!.close();
    page.find('dialog')!.fire('close');
    expect(page.find('dialog')!.open).toBe(true);
    expect(audio.running).toBe(1);
  });

  test('is silent with a banner once acknowledged, until the cause is gone', async () => {
    await shows(kIgnored);
    await acknowledge();
    expect(page.find('dialog')).toBeUndefined();
    expect(page.text).toContain('stop button on the rig must be pressed');
    expect(audio.running).toBe(0);
    expect(listeners.has('keydown')).toBe(false);
    await shows(kAtRest);
    expect(page.text).toContain('stop button on the rig must be pressed');
    await shows(kIdle);
    expect(page.text).toBe('');
  });

  test('is loud again for a new occurrence', async () => {
    await shows(kIgnored);
    await acknowledge();
    await shows(kIdle);
    await shows(kIgnored);
    expect(page.find('dialog')!.open).toBe(true);
    expect(audio.running).toBe(1);
  });
});

test("the rig page shows the alarm's number, and its text if the profile has one", () => {
  const shown = (alarm: Partial<Rig>) => {
    const page = new TinyNode(1, 'body');
    render(h(DriveAlarm, { now: { ...kAtRest, ...alarm } }), page as unknown as Element);
    return page.text;
  };
  expect(shown({ alarmCode: 48, alarmText: 'no message; check cable' })).toBe(
    'Alarm 48 of the drive: no message; check cable',
  );
  expect(shown({ alarmCode: 7 })).toBe('Alarm 7 of the drive');
  expect(shown({ alarmCode: 7, alarmText: '' })).toBe('Alarm 7 of the drive');
  expect(shown({ alarmCode: 0 })).toBe('');
  expect(shown({})).toBe('');
});
