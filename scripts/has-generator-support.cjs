// Stands in for @stdlib/assert-has-generator-support in the built page (vite.config.ts): that one asks with eval, which the page's
// policy forbids and the browser then reports. Every browser with WebXR has generators.
module.exports = () => true;
