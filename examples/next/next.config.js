/** Writes plain files into out/. A page that a server renders needs no configuration. */
export default { output: 'export' };
