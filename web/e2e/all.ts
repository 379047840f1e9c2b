// SPDX-License-Identifier: Apache-2.0
// All tests in a real browser, one after the other.
import { after, before } from "node:test";
import { start, stop } from "./browser";
import "./opening";
import "./looking";
import "./joins";
import "./access";
import "./transforms";
import "./by_hand";
import "./as_merged";
import "./following";
import "./bent";
import "./hostile";
import "./many";
import "./plan";
import "./palette";

before(start);
after(stop);
