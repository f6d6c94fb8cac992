import type { ComponentChildren } from 'preact';
import { useEffect, useLayoutEffect } from 'preact/hooks';
import { link } from './events';
import { route } from './route';
import { NewPrint } from './screens/new_print';
import { SignIn } from './screens/sign_in';
import { StopAlarm } from './screens/stop_alarm';
import { dismiss, notices } from './state/notices';
import { isMoving, stop, stopState } from './state/rig';
import { may, mustSignIn, signOut, who } from './state/session';
import { stopAlarm } from './state/stop_alarm';
import { nextTheme, theme } from './theme';
import { Icon } from './ui/icon';
import { later } from './ui/later';

const kScreens = [
  { path: '', label: 'New print', icon: 'new' },
  { path: 'jobs', label: 'Jobs', icon: 'jobs' },
  { path: 'rig', label: 'Rig', icon: 'rig' },
  { path: 'people', label: 'People', icon: 'people' },
] as const;

const kLoads = {
  job: () => import('./screens/job').then(({ JobScreen }) => JobScreen),
  queue: () => import('./screens/queue').then(({ QueueScreen }) => QueueScreen),
  rig: () => import('./screens/rig').then(({ RigScreen }) => RigScreen),
  people: () => import('./screens/people').then(({ People }) => People),
};
const JobScreen = later(kLoads.job);
const QueueScreen = later(kLoads.queue);
const RigScreen = later(kLoads.rig);
const People = later(kLoads.people);

const kPause_ms = 1000;

/** Loads the other screens once the first one is shown, because the daemon may not answer when they are needed. */
const loadOthers = (): void =>
  Object.values(kLoads).forEach((load) => void load().catch(() => undefined));

export function App() {
  if (mustSignIn.value)
    return (
      <Frame>
        <SignIn />
      </Frame>
    );
  return <Frame>{who.value ? <Screen /> : <p class="quiet">Loading…</p>}</Frame>;
}

function Screen() {
  useEffect(() => {
    const timer = window.setTimeout(loadOthers, kPause_ms);
    return () => window.clearTimeout(timer);
  }, []);
  const [first, second] = route.value.parts;
  if (first === 'jobs' && second) return <JobScreen key={second} name={`jobs/${second}`} />;
  if (first === 'jobs') return <QueueScreen />;
  if (first === 'rig') return <RigScreen />;
  if (first === 'people') return <People />;
  return <NewPrint />;
}

function Frame({ children }: { children: ComponentChildren }) {
  useEscapeToStop();
  return (
    <>
      <a class="skip" href="#main" onClick={toMain}>
        Skip to content
      </a>
      <header class="bar">
        <span class="brand">Hydroprint</span>
        {who.value && <Navigation />}
        <Account />
        {who.value && <StopButton />}
      </header>
      {who.value && <StopAlarm />}
      <ConnectionBanner />
      <main id="main" tabIndex={-1}>
        {children}
      </main>
      <Notices />
    </>
  );
}

// The hash holds the route; the browser's default action would replace it.
function toMain(event: Event): void {
  event.preventDefault();
  document.getElementById('main')?.focus();
}

function Navigation() {
  const current = route.value.parts[0] ?? '';
  return (
    <nav aria-label="Pages">
      {kScreens.map(({ path, label, icon }) => (
        <a href={`#/${path}`} aria-current={current === path ? 'page' : undefined}>
          <Icon name={icon} />
          <span>{label}</span>
        </a>
      ))}
    </nav>
  );
}

function Account() {
  const name = who.value?.user;
  return (
    <div class="account">
      {name && who.value?.accounts && (
        <>
          <span class="quiet" title={`Role: ${who.value.role.toLowerCase()}`}>
            {name}
          </span>
          <button type="button" class="plain" onClick={() => void signOut()}>
            Sign out
          </button>
        </>
      )}
      <button
        type="button"
        class="plain"
        onClick={nextTheme}
        aria-label={`Theme: ${theme.value}. Change the theme`}
        title={`Theme: ${theme.value}`}
      >
        <Icon name={theme.value} />
      </button>
    </div>
  );
}

const kStopText = { ready: 'Stop', sending: 'Stopping…', stopped: 'Stopped', failed: 'Retry stop' };

/** Shown on every screen to everyone who is signed in. A stop needs no lease and is always safe. */
function StopButton() {
  return (
    <button
      type="button"
      class={`stop ${isMoving.value ? 'moving' : ''}`}
      onClick={() => void stop()}
      title="Stops the rig. While the rig moves, the Escape key also stops it."
    >
      {kStopText[stopAlarm.value === 'off' ? stopState.value : 'ready']}
    </button>
  );
}

function useEscapeToStop(): void {
  useLayoutEffect(() => {
    const take = (event: KeyboardEvent) => {
      // If the drive does not obey, another message would only delay its own watchdog.
      const isObeyed = stopAlarm.value === 'off';
      if (event.key === 'Escape' && isMoving.value && isObeyed && may('VIEWER')) void stop();
    };
    window.addEventListener('keydown', take, { capture: true });
    return () => window.removeEventListener('keydown', take, { capture: true });
  }, []);
}

function ConnectionBanner() {
  if (!who.value || link.value !== 'lost') return null;
  return (
    <p class="banner" role="status">
      The connection to the daemon was lost. This page is trying to reconnect and may be out of
      date. The Stop button may still work; if it fails, press the stop button on the rig.
    </p>
  );
}

function Notices() {
  return (
    <div class="notices" role="status" aria-live="polite">
      {notices.value.map(({ id, kind, what, remedy }) => (
        <div key={id} class={`notice ${kind}`}>
          <p>
            {what}
            {remedy && <span class="remedy">{remedy}.</span>}
          </p>
          <button type="button" class="plain" aria-label="Dismiss" onClick={() => dismiss(id)}>
            <Icon name="close" />
          </button>
        </div>
      ))}
    </div>
  );
}
