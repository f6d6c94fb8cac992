import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { rig as api } from '../../api/services';
import { command } from '../../state/rig';
import { Switch } from '../../ui/controls';
import { Icon } from '../../ui/icon';

// The daemon stops a jog if no request arrives for 250 ms.
const kEvery_ms = 100;
const kSpeeds = ['0.5', '2', '5', '10'];

/** Moves the axis while a button or key is held; releasing it stops the axis. */
export function Jog({ fastest_mm_per_s }: { fastest_mm_per_s: number }) {
  const [speed, setSpeed] = useState('2');
  const speedNow = useRef(speed);
  speedNow.current = speed;
  const held = useRef(0);
  const isSending = useRef(false);

  const tell = async () => {
    if (held.current === 0 || isSending.current) return;
    isSending.current = true;
    const isDone = await command((id) => api.jog(id, held.current * Number(speedNow.current)));
    isSending.current = false;
    if (!isDone) held.current = 0;
  };
  const endJog = () => {
    if (held.current === 0) return;
    held.current = 0;
    void api.stop();
  };
  const hold = (direction: number) => {
    if (held.current === direction) return;
    held.current = direction;
    void tell();
  };

  // A layout effect listens before a button can be pressed; after the first paint, a release could be missed.
  useLayoutEffect(() => {
    const timer = window.setInterval(() => void tell(), kEvery_ms);
    // Losing the window's focus or the pointer also ends the jog.
    window.addEventListener('blur', endJog);
    window.addEventListener('pointerup', endJog);
    window.addEventListener('pointercancel', endJog);
    return () => {
      window.clearInterval(timer);
      window.removeEventListener('blur', endJog);
      window.removeEventListener('pointerup', endJog);
      window.removeEventListener('pointercancel', endJog);
      endJog();
    };
    // Runs once only: rendering again while the rig moves must not end the jog.
  }, []);

  const button = (direction: 1 | -1, label: string) => (
    <button
      type="button"
      class="large hold"
      onPointerDown={(event) => {
        event.preventDefault();
        event.currentTarget.focus();
        hold(direction);
      }}
      onContextMenu={(event) => event.preventDefault()}
      onKeyDown={(event) => {
        if (event.key === ' ' || event.key === 'Enter') {
          event.preventDefault();
          hold(direction);
        }
      }}
      onKeyUp={endJog}
      onBlur={endJog}
    >
      <Icon name={direction > 0 ? 'down' : 'up'} /> {label}
    </button>
  );
  return (
    <div class="jog">
      <p class="quiet">
        To move the axis, hold a button, or hold Space while a button has the focus.
      </p>
      <div class="row">
        {button(-1, 'Up')}
        {button(1, 'Down')}
      </div>
      <Switch
        label="Speed"
        value={speed}
        onValue={setSpeed}
        choices={kSpeeds
          .filter((value) => Number(value) <= fastest_mm_per_s)
          .map((value) => ({ value, label: `${value} mm/s` }))}
      />
    </div>
  );
}
