// SPDX-License-Identifier: Apache-2.0
import { useState } from "preact/hooks";
import { log_in } from "../wire/store";

export function Login({ by_token }: { by_token: boolean }) {
  const [trouble, set_trouble] = useState<string | null>(null);
  const [busy, set_busy] = useState(false);
  const submit = async (event: SubmitEvent) => {
    event.preventDefault();
    const form = new FormData(event.currentTarget as HTMLFormElement);
    set_busy(true);
    set_trouble(await log_in(String(form.get("user") ?? ""), String(form.get("password"))));
    set_busy(false);
  };
  return (
    <main class="login">
      <form class="login-form" data-testid="login" onSubmit={(event) => void submit(event)}>
        <h1>Skein ground control</h1>
        {by_token ? (
          <p data-testid="login-token">
            For who runs this ground station: <code>skein-ground tell console</code> prints the address that opens it.
          </p>
        ) : (
          <label>
            Name
            <input name="user" autocomplete="username" required autofocus data-testid="login-user" />
          </label>
        )}
        <label>
          {by_token ? "Token" : "Password"}
          <input name="password" type="password" autocomplete="current-password" required data-testid="login-password" />
        </label>
        <p class="trouble" role="alert" data-testid="login-trouble">
          {trouble}
        </p>
        <button type="submit" class="primary" disabled={busy} data-testid="login-submit">
          Log in
        </button>
      </form>
    </main>
  );
}
