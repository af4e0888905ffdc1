'use strict';
// Stores the visitor's leader and the answers in the browser (IndexedDB), so that a reload loses
// nothing. The gateway stores no files.
const STORE = 'work';

function openStore() {
  return new Promise((resolve, reject) => {
    const opening = indexedDB.open('duet', 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
    opening.onsuccess = () => resolve(opening.result);
    opening.onerror = () => reject(opening.error);
  });
}

async function inStore(mode, act) {
  const database = await openStore();
  try {
    return await new Promise((resolve, reject) => {
      const transaction = database.transaction(STORE, mode);
      const request = act(transaction.objectStore(STORE));
      transaction.oncomplete = () => resolve(request.result);
      transaction.onerror = transaction.onabort = () => reject(transaction.error);
    });
  } finally {
    database.close();
  }
}

// Stores the leader, {name, file, bytes, motion, notes, reading}, the answers and the rig. The page also
// works if the browser stores nothing (a private window, a full disk).
async function keepWork() {
  const {leader, takes, chosen, asked, rig} = state;
  try {
    await inStore('readwrite', (store) => store.put({leader, takes, chosen, asked, rig}, 'current'));
    root.dataset.kept = Number(root.dataset.kept ?? 0) + 1;
  } catch (error) {
    console.warn(`The browser cannot store this page's work: ${error}`);
  }
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
