import { defineConfig } from 'vite';

// Fixed names: the C++ build embeds these three files, so that their list never changes.
export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1200,
    rollupOptions: {
      output: {
        entryFileNames: 'assets/page.js',
        assetFileNames: 'assets/page[extname]',
        inlineDynamicImports: true,
      },
    },
  },
  test: { include: ['src/**/*.test.ts'] },
});
