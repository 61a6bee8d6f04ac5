// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vite";

// Where `npm run dev` finds a running skein-ground.
const ground = process.env["SKEIN_GROUND"] ?? "http://127.0.0.1:8080";

export default defineConfig({
  // The server forbids inline scripts, styles and data: addresses (Content-Security-Policy).
  build: {
    target: "es2021",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    reportCompressedSize: true,
  },
  esbuild: { jsx: "automatic", jsxImportSource: "preact", legalComments: "none" },
  server: {
    host: "127.0.0.1",
    proxy: {
      "/socket": { target: ground, ws: true },
      "/session": ground,
      "/tiles": ground,
      "/overlays": ground,
    },
  },
});
