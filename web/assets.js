// Files of examples and of the manual, which web/build puts into a folder beside the module.

const folder = new URL("../../../assets/", import.meta.url); // from snippets/…/web

/** Fetches one of them. */
export async function load(name) {
  const response = await fetch(new URL(name, folder));
  if (!response.ok) {
    throw new Error(`${response.status} ${response.statusText}`.trim());
  }
  return new Uint8Array(await response.arrayBuffer());
}
