import { afterAll, beforeEach, describe, expect, test, vi } from 'vitest';
import { add, remove } from '../src/model/dips';
import { kUpright } from '../src/model/pose';
import { change, clear, draft, shape } from '../src/screens/new_print/draft';
import { History } from '../src/screens/new_print/history';
import {
  canRedo,
  canUndo,
  commandOf,
  nextStep,
  record,
  redo,
  undo,
} from '../src/screens/new_print/undo';
import { shapeOf } from './shapes';

vi.mock('../src/worker/reader', () => ({}));

describe('a history', () => {
  test('goes back and forth', () => {
    const history = new History(0);
    history.add(1, 'a');
    history.add(2, 'b');
    expect([history.undo(), history.undo(), history.undo()]).toEqual([1, 0, 0]);
    expect(history.canUndo).toBe(false);
    expect([history.redo(), history.redo(), history.redo()]).toEqual([1, 2, 2]);
    expect(history.canRedo).toBe(false);
  });

  test('counts an action as one step, but not after an undo', () => {
    const history = new History(0);
    [1, 2, 3].forEach((state) => history.add(state, 'drag'));
    expect(history.undo()).toBe(0);
    history.add(4, 'drag');
    expect(history.canRedo).toBe(false);
    expect(history.undo()).toBe(0);
  });

  test('forgets what was undone once something else is done, and its oldest steps', () => {
    const history = new History(0);
    history.add(1, 'a');
    history.undo();
    history.add(2, 'b');
    expect(history.redo()).toBe(2);
    for (let i = 0; i < 500; i += 1) history.add(i, i);
    let steps = 0;
    for (; history.canUndo; steps += 1) history.undo();
    expect(steps).toBe(200);
  });
});

describe('steps of the draft', () => {
  const end = record();
  afterAll(end);

  const newObject = () => {
    clear();
    change({ files: [{ name: 'bunny.stl' } as File] });
    shape.value = shapeOf();
  };
  beforeEach(newObject);

  test('are changes of the layer, the pose and the scale', () => {
    expect(canUndo.value).toBe(false);
    nextStep();
    change({ layer: { projection: 'box' } });
    nextStep();
    change({ pose: { ...kUpright, centre_mm: [5, 0] } });
    change({ pose: { ...kUpright, centre_mm: [6, 0] } });
    nextStep();
    change({ name: 'other', scale: 10 });
    undo();
    expect(draft.value).toMatchObject({ name: 'other', scale: 1, pose: { centre_mm: [6, 0] } });
    undo();
    expect(draft.value).toMatchObject({ pose: kUpright, layer: { projection: 'box' } });
    undo();
    expect(draft.value.layer).toEqual({});
    expect([canUndo.value, canRedo.value]).toEqual([false, true]);
    redo();
    redo();
    redo();
    expect(draft.value).toMatchObject({ scale: 10, pose: { centre_mm: [6, 0] } });
  });

  test('are additions and removals of dips', () => {
    nextStep();
    change(add(draft.value));
    nextStep();
    change(remove(draft.value, 0));
    undo();
    expect(draft.value.before).toEqual([{ pose: kUpright }]);
    undo();
    expect(draft.value).toMatchObject({ before: [], pose: kUpright, after: [] });
  });

  test('have a request id of their own', () => {
    nextStep();
    change({ layer: { projection: 'box' } });
    const { requestId } = draft.value;
    undo();
    expect(draft.value.requestId).not.toBe(requestId);
  });

  test('begin again with another object', () => {
    nextStep();
    change({ layer: { projection: 'box' } });
    newObject();
    expect(canUndo.value).toBe(false);
  });
});

describe('keys', () => {
  const key = (name: string, more = {}) => ({
    key: name,
    ctrlKey: true,
    metaKey: false,
    shiftKey: false,
    altKey: false,
    ...more,
  });

  test('undo and redo', () => {
    expect(commandOf(key('z'), false)).toBe('undo');
    expect(commandOf(key('z', { ctrlKey: false, metaKey: true }), false)).toBe('undo');
    expect(commandOf(key('Z', { shiftKey: true }), false)).toBe('redo');
    expect(commandOf(key('y'), false)).toBe('redo');
  });

  test('are left to fields, and to other uses', () => {
    expect(commandOf(key('z'), true)).toBeUndefined();
    expect(commandOf(key('z', { ctrlKey: false }), false)).toBeUndefined();
    expect(commandOf(key('z', { altKey: true }), false)).toBeUndefined();
    expect(commandOf(key('a'), false)).toBeUndefined();
  });
});
