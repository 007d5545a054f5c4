"""From motion capture to the networks in public/models: prepare, features, model, train, export."""
