// SPDX-License-Identifier: Apache-2.0
// Rules that find faults; how lines look is left to .editorconfig.
import js from "@eslint/js";
import globals from "globals";

const found = ["array-callback-return", "block-scoped-var", "consistent-return", "default-case-last", "eqeqeq",
  "guard-for-in", "no-caller", "no-constructor-return", "no-eval", "no-extend-native", "no-implicit-coercion",
  "no-implicit-globals", "no-implied-eval", "no-lone-blocks", "no-loop-func", "no-new-func", "no-new-wrappers",
  "no-param-reassign", "no-promise-executor-return", "no-return-assign", "no-self-compare", "no-sequences",
  "no-shadow", "no-template-curly-in-string", "no-throw-literal", "no-unmodified-loop-condition",
  "no-unreachable-loop", "no-unused-expressions", "no-useless-assignment", "no-useless-concat",
  "no-useless-rename", "no-useless-return", "no-var", "prefer-const", "prefer-promise-reject-errors", "radix"];

export default [
  js.configs.recommended,
  {
    linterOptions: { reportUnusedDisableDirectives: "error" },
    languageOptions: { ecmaVersion: 2024, sourceType: "module" },
    rules: {
      ...Object.fromEntries(found.map((rule) => [rule, "error"])),
      "no-unused-vars": ["error", { argsIgnorePattern: "^_" }],
      "no-use-before-define": ["error", { functions: false, classes: false, variables: false }],
      "require-atomic-updates": ["error", { allowProperties: true }],
    },
  },
  { files: ["web/**"], languageOptions: { globals: globals.browser } },
  // Code that a visit evaluates in its page stands among code that Node runs.
  { files: ["tests/**"], languageOptions: { globals: { ...globals.node, ...globals.browser } } },
];
