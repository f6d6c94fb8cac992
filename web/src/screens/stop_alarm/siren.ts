const kTone_hz = 880;
const kBeat_hz = 1.5;
const kVolume = 0.5;
const kGestures = ['pointerdown', 'pointerup', 'keydown'];

/**
 * Starts a tone that is switched on and off by a slow second oscillator, so that it repeats without a timer. A browser may
 * forbid sound before the first gesture; the tone then begins with that gesture. Returns a function that ends it.
 */
export function startSiren(): () => void {
  if (typeof AudioContext === 'undefined') return () => {};
  const audio = new AudioContext();
  const tone = new OscillatorNode(audio, { type: 'square', frequency: kTone_hz });
  const beat = new OscillatorNode(audio, { type: 'square', frequency: kBeat_hz });
  // The volume alternates between 0 and kVolume.
  const volume = new GainNode(audio, { gain: kVolume / 2 });
  const swing = new GainNode(audio, { gain: kVolume / 2 });
  beat.connect(swing).connect(volume.gain);
  tone.connect(volume).connect(audio.destination);
  for (const oscillator of [tone, beat]) oscillator.start();

  const begin = () => void audio.resume().catch(() => {});
  begin();
  for (const kind of kGestures) window.addEventListener(kind, begin, { capture: true });
  return () => {
    for (const kind of kGestures) window.removeEventListener(kind, begin, { capture: true });
    void audio.close();
  };
}
