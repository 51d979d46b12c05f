// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of the pages' scripts and of the tests that drive a browser (tests/lint_scripts runs them).
import js from './tools/report/web/node_modules/@eslint/js/src/index.js';

const names = (kind, ...list) => Object.fromEntries(list.map((name) => [name, kind]));
const browser = names(
  'readonly',
  ...['window', 'document', 'Node', 'fetch', 'location', 'history', 'localStorage', 'sessionStorage', 'navigator', 'performance'],
  ...['setTimeout', 'clearTimeout', 'setInterval', 'clearInterval', 'requestAnimationFrame', 'cancelAnimationFrame', 'matchMedia'],
  ...[
    'addEventListener',
    'devicePixelRatio',
    'OffscreenCanvas',
    'ResizeObserver',
    'IntersectionObserver',
    'MutationObserver',
    'EventSource',
    'AbortController',
    'FormData',
    'FileReader',
    'Blob',
    'URL',
  ],
  ...['URLSearchParams', 'TextDecoder', 'TextEncoder', 'atob', 'btoa', 'getComputedStyle', 'CustomEvent', 'Event', 'Option', 'console'],
);
const node = names(
  'readonly',
  'process',
  'console',
  'Buffer',
  'setTimeout',
  'clearTimeout',
  'setInterval',
  'clearInterval',
  'fetch',
  'URL',
  'performance',
);

export default [
  { ignores: ['build/**', '**/node_modules/**'] },
  js.configs.recommended,
  {
    rules: {
      eqeqeq: ['error', 'always', { null: 'ignore' }],
      'no-var': 'error',
      'prefer-const': 'error',
      'no-implied-eval': 'error',
      'no-eval': 'error',
      'no-shadow': 'error',
      'no-unused-expressions': 'error',
      'no-use-before-define': ['error', { functions: false, variables: false }],
    },
  },
  { files: ['tools/**/*.js'], languageOptions: { globals: browser } },
  { files: ['tests/**/*.mjs', 'eslint.config.mjs'], languageOptions: { globals: node } },
];
