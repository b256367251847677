import { together } from './together.mjs';

await together(0);
