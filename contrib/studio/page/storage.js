'use strict';
// Stores the visitor's leader and the answers in the browser (IndexedDB), so that a reload keeps them. The
// gateway stores no files.
const STORE = 'work';
const KEEP_SECONDS = 0.5;

let database = null;  // stays open: a page that is left has no time to open it

function openStore() {
  return new Promise((resolve, reject) => {
    const opening = indexedDB.open('duet', 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
    opening.onsuccess = () => {
      database = opening.result;
      database.onclose = () => { database = null; };
      resolve();
    };
    opening.onerror = () => reject(opening.error);
  });
}

async function inStore(mode, act) {
  if (!database) await openStore();
  return new Promise((resolve, reject) => {
    const transaction = database.transaction(STORE, mode);
    const request = act(transaction.objectStore(STORE));
    transaction.oncomplete = () => resolve(request.result);
    transaction.onerror = transaction.onabort = () => reject(transaction.error);
    transaction.commit();
  });
}

// Stores the leader, {name, file, bytes, motion, notes, reading}, the answers and the rig. The page also
// works if the browser stores nothing (a private window, a full disk).
async function keepWork() {
  const {leader, takes, chosen, asked, rig} = state;
  try {
    await inStore('readwrite', (store) => store.put(
        {leader, takes, chosen, asked, rig, address: addressOf(settings)}, 'current'));
    root.dataset.kept = Number(root.dataset.kept ?? 0) + 1;
  } catch (error) {
    console.warn(`The browser cannot store this page's work: ${error}`);
  }
}

let waiting = null;  // the timer of a change that is not stored yet

// As keepWork, but once for changes that follow each other quickly.
function keepSoon() {
  waiting ??= setTimeout(keepNow, 1000 * KEEP_SECONDS);
}

// Stores what keepSoon has not stored yet.
function keepNow() {
  if (waiting === null) return undefined;
  clearTimeout(waiting);
  waiting = null;
  return keepWork();
}

async function keptWork() {
  try {
    return await inStore('readonly', (store) => store.get('current'));
  } catch {
    return undefined;
  }
}

// A hash of a file's bytes, to distinguish files of the same name.
function fingerprint(bytes) {
  let hash = 0x811c9dc5;  // FNV-1a
  for (const byte of new Uint8Array(bytes)) hash = Math.imul(hash ^ byte, 0x01000193);
  return (hash >>> 0).toString(16).padStart(8, '0');
}
