// Writes config.json with a tenant and two tokens, which are told once, unless it is there. The settings hold digests alone.
import { createHash, randomBytes } from 'node:crypto';
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const path = fileURLToPath(new URL('../config.json', import.meta.url));
mkdirSync(fileURLToPath(new URL('../data/workerd', import.meta.url)), { recursive: true });
if (!existsSync(path)) {
  const tokens = ['write', 'read'].map((role) => {
    const token = randomBytes(32).toString('base64url');
    console.log(`token of tenant demo that may ${role}: ${token}`);
    return { sha256: createHash('sha256').update(token).digest('hex'), role };
  });
  writeFileSync(path, `${JSON.stringify({ tenants: { demo: { tokens } } }, null, 2)}\n`, { mode: 0o600 });
}
