/** Values that outlive the page, files too: one table of the browser's own database. */
const kTable = 'values';
let opened: Promise<IDBDatabase> | undefined;

function database(): Promise<IDBDatabase> {
  opened ??= new Promise((resolve, reject) => {
    const request = indexedDB.open('hydroprint', 1);
    request.onupgradeneeded = () => request.result.createObjectStore(kTable);
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error ?? new Error('no database'));
  });
  return opened;
}

/** What was kept under that name; undefined if nothing was, or the browser keeps nothing. */
export async function load<T>(key: string): Promise<T | undefined> {
  try {
    const table = (await database()).transaction(kTable).objectStore(kTable);
    return await new Promise((resolve, reject) => {
      const request = table.get(key);
      request.onsuccess = () => resolve(request.result as T | undefined);
      request.onerror = () => reject(request.error ?? new Error('unreadable'));
    });
  } catch {
    return undefined;
  }
}

/** Keeps a value; in a private window it is gone with the page, which is no failure. */
export async function save(key: string, value: unknown): Promise<void> {
  try {
    const transaction = (await database()).transaction(kTable, 'readwrite');
    transaction.objectStore(kTable).put(value, key);
    await new Promise((resolve, reject) => {
      transaction.oncomplete = resolve;
      transaction.onabort = reject;
    });
  } catch {
    return;
  }
}
