// SPDX-License-Identifier: MIT
export function timeline() {}
