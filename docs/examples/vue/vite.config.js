import vue from '@vitejs/plugin-vue';
import { defineConfig } from 'vite';

// Without this Vue takes the elements for components of its own.
const isCustomElement = (tag) => tag.startsWith('boresight-');

export default defineConfig({
  plugins: [vue({ template: { compilerOptions: { isCustomElement } } })],
});
