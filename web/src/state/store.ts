/** Persistent values, including files, in one table of the browser's IndexedDB. */
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

/** Returns the value stored under the key; undefined if there is none or the browser has no storage. */
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

/** Stores a value. Errors are ignored: a private window, for example, may not allow storage. */
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
