// The picture of a page that the README shows: node tests/page/picture.mjs PAGE.html PICTURE.png
// The first screenful, down to the chart of error against cost: of a result the answer and its table,
// of a judgement the verdicts.
import {execFileSync} from 'node:child_process';
import {resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

const [, , page_file, picture_file] = process.argv;
if (!picture_file) {
  console.error('usage: node tests/page/picture.mjs PAGE.html PICTURE.png');
  process.exit(2);
}
const executablePath =
  process.env.CHROMIUM ?? execFileSync('which', ['chromium'], {encoding: 'utf8'}).trim();
const browser = await chromium.launch({executablePath, args: ['--no-sandbox', '--disable-gpu']});
const page = await browser.newPage({viewport: {width: 1180, height: 1200}});
await page.goto(pathToFileURL(resolve(page_file)).href);
await page.waitForSelector('#chart-cost svg, #chart-trade svg');
const chart = await page.locator('#chart-cost, #chart-trade').boundingBox();
const height = Math.ceil(chart.y + chart.height + 20);
await page.screenshot({path: picture_file, fullPage: true, clip: {x: 0, y: 0, width: 1180, height}});
await browser.close();
