// Runs before all other modules, on any version of Node: syntax of 2015, no packages.
const { readFileSync } = require('fs');
const { join } = require('path');

const needed = JSON.parse(readFileSync(join(__dirname, '..', 'package.json'), 'utf8')).engines.node;
const found = process.versions.node;

/**
 * Returns whether a version satisfies a range in package.json's form, caret or lower bound: '^20.19.0 || >=22.12.0'.
 */
function satisfies(version, range) {
  const numbers = version.split('.').map(Number);
  return range.split('||').some((alternative) => {
    const wanted = alternative
      .replace(/[^0-9.]/g, '')
      .split('.')
      .map(Number);
    if (alternative.indexOf('^') >= 0 && numbers[0] !== wanted[0]) return false;
    const different = wanted.findIndex((number, index) => numbers[index] !== number);
    return different < 0 || numbers[different] > wanted[different];
  });
}

if (!satisfies(found, needed)) {
  console.error(`threepoint needs Node ${needed}; this is Node ${found} (${process.execPath}).
Install a current one from https://nodejs.org or with your version manager, for instance: nvm install 22`);
  process.exit(1);
}
