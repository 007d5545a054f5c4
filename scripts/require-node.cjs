// Runs before everything else, on whatever Node there is: old syntax only, nothing installed yet.
var fs = require('fs');
var path = require('path');
var engines = JSON.parse(fs.readFileSync(path.join(__dirname, '..', 'package.json'), 'utf8')).engines;

// The form of package.json: alternatives of a caret or a lower bound, '^20.19.0 || >=22.12.0'.
function satisfies(version, range) {
  return range.split('||').some(function (alternative) {
    var caret = alternative.indexOf('^') >= 0;
    var wanted = alternative.replace(/[^0-9.]/g, '').split('.').map(Number);
    if (caret && version[0] !== wanted[0]) return false;
    for (var i = 0; i < wanted.length; i++) {
      if (version[i] !== wanted[i]) return version[i] > wanted[i];
    }
    return true;
  });
}

if (!satisfies(process.versions.node.split('.').map(Number), engines.node)) {
  console.error(
    'threepoint needs Node ' + engines.node + '; this is Node ' + process.versions.node + ' (' + process.execPath + ').\n' +
      'Install a current one from https://nodejs.org or with your version manager, for instance: nvm install 22'
  );
  process.exit(1);
}
