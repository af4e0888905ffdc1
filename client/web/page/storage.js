'use strict';
// The visitor's leader and the answers to it, in the browser (IndexedDB): a reload loses nothing,
// and no file is kept at the gateway.
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

// Keeps the leader, {name, file, bytes, motion, notes, reading}, and the answers. Where a browser
// keeps nothing (a private window, a full disk) the page works all the same.
async function keepWork() {
  const {leader, takes, chosen, asked} = state;
  try {
    await inStore('readwrite', (store) => store.put({leader, takes, chosen, asked}, 'current'));
    root.dataset.kept = Number(root.dataset.kept ?? 0) + 1;
  } catch (error) {
    console.warn(`The browser does not keep this page's work: ${error}`);
  }
}

async function keptWork() {
  try {
    return await inStore('readonly', (store) => store.get('current'));
  } catch {
    return undefined;
  }
}

// Of a file's bytes: tells files of one name apart.
function fingerprint(bytes) {
  let hash = 0x811c9dc5;  // FNV-1a
  for (const byte of new Uint8Array(bytes)) hash = Math.imul(hash ^ byte, 0x01000193);
  return (hash >>> 0).toString(16).padStart(8, '0');
}
