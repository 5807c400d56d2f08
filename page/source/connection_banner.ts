import { append, button, fill, make } from "./dom.js";

/**
 * Says that the server is gone, and leads to a new one: that has another port and token, so that its address is asked
 * for. What is shown goes along in the address.
 */
export class ConnectionBanner {
  readonly root = make("div", { class: "banner", role: "alert", hidden: true });

  constructor(private readonly state: () => string) {}

  show(state: "open" | "lost" | "refused" | "ended"): void {
    this.root.hidden = state === "open";
    if (state === "open") return fill(this.root);
    if (this.root.dataset.state === state && this.root.childElementCount > 0) return; // what is being typed stays
    this.root.dataset.state = state;
    const words =
      state === "refused"
        ? "Another server answers at this address now, with another token."
        : "The server does not answer: it was ended, or its machine sleeps. What you see stays; nothing can be computed.";
    const field = make("input", {
      type: "text",
      size: 46,
      placeholder: "http://127.0.0.1:PORT/?token=…",
      "aria-label": "Address of the new server",
    });
    const problem = make("span");
    const go = () => {
      const address = newAddress(field.value);
      if (!address) return void (problem.textContent = "This is no address that graze view prints.");
      // The same address is not loaded anew when only what follows its # changes.
      const same = new URL(address).origin === location.origin;
      if (same) history.replaceState(null, "", `${address}#${this.state()}`);
      if (same) location.reload();
      else location.href = `${address}#${this.state()}`;
    };
    const form = make("form", { class: "row" }, field, button("Go on there", go));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      go();
    });
    fill(this.root, make("p", {}, `${words} Start \`graze view\` again and paste the address that it prints:`), form);
    append(this.root, problem);
  }
}

/** Only addresses of this machine with a token lead anywhere. */
function newAddress(text: string): string | null {
  try {
    const address = new URL(text.trim());
    const own = address.hostname === "127.0.0.1" || address.hostname === "localhost";
    if (address.protocol !== "http:" || !own || !address.searchParams.get("token")) return null;
    return `${address.origin}/?token=${encodeURIComponent(address.searchParams.get("token") ?? "")}`;
  } catch {
    return null;
  }
}
