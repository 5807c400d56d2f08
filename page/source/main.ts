import { LiveSource } from "./live_source.js";
import { recall, remember } from "./memory.js";
import { Page, showFailure } from "./page.js";
import { ConnectionBanner } from "./connection_banner.js";
import { Refusal, type Source } from "./source.js";
import { StoredSource, type StoredPage } from "./stored_source.js";

/** The data inside of this file, or else the server that gave it. */
function sourceOf(): Source {
  const stored = document.getElementById("stored")?.textContent?.trim();
  if (stored) return new StoredSource(JSON.parse(stored) as StoredPage);
  const address = new URL(location.href),
    given = address.searchParams.get("token");
  if (given) {
    // The token leaves the address bar, so that nobody copies it, and stays in this tab, so that it can be reloaded.
    remember("token", given);
    address.searchParams.delete("token");
    history.replaceState(null, "", address.pathname + address.search + address.hash);
  }
  return new LiveSource(given ?? recall<string>("token") ?? "");
}

async function start(): Promise<void> {
  const root = document.getElementById("page");
  if (!root) return;
  try {
    await Page.open(sourceOf(), root);
  } catch (error) {
    showFailure(root, error);
    if (!(error instanceof Refusal)) throw error;
    const banner = new ConnectionBanner(() => "");
    banner.show(error.status === 401 || error.status === 403 ? "refused" : "lost");
    root.append(banner.root);
  }
}

void start();
