import { useLayoutEffect, useRef } from 'preact/hooks';
import { acknowledge, stopAlarm } from '../../state/stop_alarm';
import { startSiren } from './siren';

/** Covers every screen while the drive does not obey a stop. Once acknowledged, it is a banner. */
export function StopAlarm() {
  if (stopAlarm.value === 'loud') return <Loud />;
  if (stopAlarm.value === 'acknowledged') return <Reminder />;
  return null;
}

function Loud() {
  const dialog = useRef<HTMLDialogElement>(null);
  const title = useRef<HTMLHeadingElement>(null);
  const open = () => {
    if (!dialog.current?.isConnected || dialog.current.open) return;
    dialog.current.showModal();
    // Not the button: a key that is being typed or held, as for a jog, would press it.
    title.current!.focus();
  };
  useLayoutEffect(() => {
    const shown = dialog.current!;
    open();
    const silence = startSiren();
    return () => {
      silence();
      shown.close();
    };
  }, []);
  // A browser may close a dialog without asking, for example at a second Escape; it is then opened again.
  return (
    <dialog
      ref={dialog}
      class="alarm"
      role="alertdialog"
      aria-labelledby="alarm-title"
      aria-describedby="alarm-text"
      onCancel={(event) => event.preventDefault()}
      onClose={open}
    >
      <h1 id="alarm-title" ref={title} tabIndex={-1}>
        Press the stop button on the rig
      </h1>
      <div id="alarm-text">
        <p>
          The drive acknowledged a stop, but it does not slow down. Software can do nothing more. If
          you are not at the rig, call somebody who is.
        </p>
        <p>Then: check the drive, release the stop button, reset, arm and home the rig.</p>
      </div>
      <button type="button" onClick={acknowledge}>
        I have pressed it
      </button>
    </dialog>
  );
}

const Reminder = () => (
  <p class="banner alarm" role="alert">
    <strong>The drive did not obey a stop: the stop button on the rig must be pressed.</strong> Then
    check the drive, release the stop button, reset, arm and home the rig.
  </p>
);
