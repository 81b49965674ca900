// Unsaved work in the storage of the browser, by tab. A tab holds a lock as long as it lives, so that others know whose work was
// left behind. Without storage (a private window, storage that is forbidden or full) the promises fail with a sentence.

const DATABASE = "meshbrush";
const STORE = "work";
const own = crypto.randomUUID();
let opened;

function open() {
  opened ??= new Promise((resolve, reject) => {
    const request = indexedDB.open(DATABASE, 1);
    request.onupgradeneeded = () => request.result.createObjectStore(STORE);
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
    request.onblocked = () => reject(new Error("another tab blocks it"));
  });
  return opened;
}

async function within(mode, act) {
  const database = await open();
  return new Promise((resolve, reject) => {
    const transaction = database.transaction(STORE, mode);
    const request = act(transaction.objectStore(STORE));
    transaction.oncomplete = () => resolve(request.result);
    transaction.onabort = transaction.onerror = () => reject(transaction.error ?? request.error);
  });
}

/** Tells other tabs that this one lives. */
export function live() {
  navigator.locks?.request(`${DATABASE} ${own}`, () => new Promise(() => {}));
}

/** Keeps the work of this tab: the bytes of a project, the name of its file, and the second since 1970. */
export function keep(bytes, home, time) {
  return within("readwrite", (store) => store.put({ bytes, home, time }, own));
}

/** Forgets the work of a tab, or of this one. */
export function forget(tab) {
  return within("readwrite", (store) => store.delete(tab ?? own));
}

/** Returns whether a tab is gone. One that was just left or loaded again holds its lock a moment longer. */
async function isGone(tab) {
  try {
    await navigator.locks?.request(`${DATABASE} ${tab}`, { signal: AbortSignal.timeout(5000) }, () => {});
    return true;
  } catch {
    return false;
  }
}

/** Returns the work that tabs left behind: [tab, bytes, home, time] of each. */
export async function left() {
  const tabs = await within("readonly", (store) => store.getAllKeys());
  const found = await Promise.all(tabs.filter((tab) => tab !== own).map(async (tab) => {
    const work = (await isGone(tab)) && (await within("readonly", (store) => store.get(tab)));
    return work ? [[tab, work.bytes, work.home, work.time]] : [];
  }));
  return found.flat();
}
