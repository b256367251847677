import { together } from './lib/together.mjs';

await together(1);
